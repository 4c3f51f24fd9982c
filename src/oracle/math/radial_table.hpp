/// Reads a RadialTable.
#pragma once

#include "dermis/tap_tables.hpp"
#include "oracle/math/rounding.hpp"

namespace dermis::oracle {

/// Returns the value of one channel at the distance r, whose fourth power is r4, in the table's unit of length.
Bounded look_up(const RadialTable& table, int channel, Bounded r4);

}  // namespace dermis::oracle
