// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/crc.hpp>

namespace skein::can {

/// CRC-16/CCITT-FALSE: polynomial 0x1021, start 0xFFFF, not reflected, no final inversion.
/// "123456789" gives 0x29B1. Used by DroneCAN's transfers and by the multicast datagrams.
using Crc16 = boost::crc_optimal<16, 0x1021, 0xFFFF, 0, false, false>;

}  // namespace skein::can
