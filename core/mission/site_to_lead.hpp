// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "skein/coalition/initiator.hpp"

namespace skein::mission {

/// A surveyed site that needs a leader.
struct SurveyedSite {
  Site site;
  std::vector<TaskId> over;  ///< its tasks that need nobody, as far as is known here
};

/// That was led here, and shall be led later.
struct PutOffSite {
  Site site;
  std::vector<coalition::Initiator::Outstanding> outstanding;
  coalition::Initiator::Electorate electorate;
};

}  // namespace skein::mission
