// The cases that the benchmark prints and stress_test.cpp asserts are one and the same.
// NOLINTBEGIN(bugprone-suspicious-include)
#include "../../bench/stress.cpp"
#include "../../bench/stress_bad.cpp"
#include "../../bench/stress_field.cpp"
#include "../../bench/stress_light.cpp"
#include "../../bench/stress_shape.cpp"
#include "../../bench/stress_sums.cpp"
// NOLINTEND(bugprone-suspicious-include)
