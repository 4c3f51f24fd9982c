// The table behind the profile of random walks.
#pragma once

#include <string>

namespace dermis::bench {

/// The text of src/profile/walk_table.cpp, the same whenever it is made, by walks and fits that take two minutes.
std::string make_walk_table();

}  // namespace dermis::bench
