// The errors of a result against the oracle.
#pragma once

#include "dermis/oracle/reference.hpp"
#include "stress/rows.hpp"

namespace dermis::bench {

/// The errors of a result, collected over parts of a frame.
class StressErrors {
 public:
  explicit StressErrors(Format format) : format_(format) {}

  /// Takes in `width` pixels of every row: those of `seen` from column `seen_x` on, which `expected` has from column
  /// `expected_x` on.
  void add(const oracle::Picture& seen, int seen_x, const oracle::Reference& expected, int expected_x, int width);

  /// Writes rel_l2, max_rel and max_ulp of all values or of those that the oracle is sure of, and of_bound and
  /// non_finite of all. The oracle is not sure where float32 cannot tell which level of taps is meant, or whether the
  /// kernel is half a pixel wide: there the bound takes in both outcomes.
  void write_to(StressRow& row, bool sure_values_only) const;

  /// The share of the values that the oracle is sure of.
  double sure_share() const { return values_ > 0 ? static_cast<double>(sure_) / static_cast<double>(values_) : 0; }

 private:
  struct Sums {
    double errors2 = 0;
    double truths2 = 0;
    double max_rel = 0;
    double max_ulp = 0;

    void add(double error, double truth, double last_place);
  };

  Format format_;
  Sums all_, of_sure_;
  double of_bound_ = 0;
  long non_finite_ = 0;
  long values_ = 0;
  long sure_ = 0;
};

}  // namespace dermis::bench
