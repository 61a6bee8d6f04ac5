// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace skein::hil {

/// From now on SIGINT and SIGTERM ask for an end; the second one ends the program as ever.
void listen_for_stop();
[[nodiscard]] bool asked_to_stop();

}  // namespace skein::hil
