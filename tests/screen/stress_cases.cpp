// The cases that the benchmark prints and stress_test.cpp asserts are one and the same.
// NOLINTBEGIN(bugprone-suspicious-include)
#include "stress/stress.cpp"
#include "stress/stress_bad.cpp"
#include "stress/stress_field.cpp"
#include "stress/stress_light.cpp"
#include "stress/stress_shape.cpp"
#include "stress/stress_sums.cpp"
// NOLINTEND(bugprone-suspicious-include)
