/// Reading a RadialTable.
#pragma once

#include "dermis/taps.hpp"
#include "oracle/rounding.hpp"

namespace dermis::oracle {

/// The value at the squared distance r2 for one channel, in the table's own unit.
Bounded look_up(const RadialTable& table, int channel, Bounded r2);

}  // namespace dermis::oracle
