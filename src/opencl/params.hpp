// kernels/params.h, as C++.
#pragma once

namespace dermis::params {
#include "params.h"
}
