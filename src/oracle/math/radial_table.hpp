/// Reading a RadialTable.
#pragma once

#include "dermis/tap_tables.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// The value at the distance r for one channel, in the table's own unit; r4 = r^4.
Bounded look_up(const RadialTable& table, int channel, Bounded r4);

}  // namespace dermis::oracle
