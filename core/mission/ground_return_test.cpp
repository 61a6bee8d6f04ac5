// SPDX-License-Identifier: Apache-2.0
#include "skein/mission/ground_return.hpp"

#include <gtest/gtest.h>
