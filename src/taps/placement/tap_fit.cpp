#include "taps/placement/tap_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace dermis {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A tap between two pixels reads such a share of each.
struct PixelShare {
  int offset_px;
  double share;
};

std::array<PixelShare, 2> pixels_of(double offset_px) {
  const int below = static_cast<int>(offset_px);
  const double fraction = offset_px - below;
  return {{{below, 1 - fraction}, {below + 1, fraction}}};
}

/// The moments of a function of frequency, computed when first asked for: few are.
class Moments {
 public:
  /// The moments of a function that is given at the coarse frequencies.
  static Moments of_coarse(const PowerGrid& grid, VectorXd at_coarse) {
    return {grid, std::move(at_coarse), VectorXd::Constant(grid.fine.size(), unknown), true};
  }
  /// The moments of a function that is given at the fine frequencies. `many`: all are computed at once.
  static Moments of_fine(const PowerGrid& grid, VectorXd at_fine, bool many) {
    VectorXd moments = many ? grid.moments(at_fine) : VectorXd(VectorXd::Constant(grid.fine.size(), unknown));
    return {grid, std::move(at_fine), std::move(moments), false};
  }

  double operator[](int k) const {
    double& moment = moments_[k];
    if (std::isnan(moment)) moment = is_coarse_ ? grid_->moments_of_coarse().col(k).dot(x_) : grid_->moment(x_, k);
    return moment;
  }

 private:
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  Moments(const PowerGrid& grid, VectorXd x, VectorXd moments, bool is_coarse)
      : grid_(&grid), x_(std::move(x)), moments_(std::move(moments)), is_coarse_(is_coarse) {}

  const PowerGrid* grid_;
  VectorXd x_;
  mutable VectorXd moments_;
  bool is_coarse_;
};

/// Equations for the weights x of pairs, term after term, that make x^T matrix x / 2 - right^T x least. Only the lower
/// half of `matrix` is filled.
struct Equations {
  MatrixXd matrix;
  VectorXd right;
};

/// The squared error of one channel as a quadratic form in the weights of pairs. The centre takes what is left of the
/// sum, so that a pair of weight w adds w (2 cos(u o) - 2) to the response.
class QuadraticForm {
 public:
  /// `searches`: it is to be solved for many offsets.
  QuadraticForm(const ChannelOnPixels& channel, const Responses& beta, const VectorXd& sums, bool joint, bool searches);

  /// The least value over the weights of pairs at these offsets, and the weights, a column per term.
  double solve(const std::vector<double>& offsets_px, const std::vector<bool>& non_negative, MatrixXd* weights) const {
    return solve(equations(offsets_px), non_negative, weights);
  }

  /// The two steps of it: one set of equations for all terms if they are changed together, else one for each.
  std::vector<Equations> equations(const std::vector<double>& offsets_px) const;
  double solve(const std::vector<Equations>& equations, const std::vector<bool>& non_negative, MatrixXd* weights) const;
  /// The least value if all weights might be negative, which is sooner known and never more.
  double bound(const std::vector<Equations>& equations) const;
  /// Puts another offset of one of the pairs into the equations.
  void move(std::vector<Equations>& equations, const std::vector<double>& offsets_px, std::size_t pair) const;

 private:
  /// Solves the equations for the terms from `first` on and puts the weights in their columns; returns the change of
  /// the error, which is not above 0.
  double change(const Equations& its, int first, const std::vector<bool>& non_negative, MatrixXd* weights) const;
  /// Fills the rows of a pair, in the columns of the first `others` pairs.
  void fill(std::vector<Equations>& equations, const std::vector<double>& offsets_px, std::size_t pair,
            std::size_t others) const;
  /// Puts the equations into factor_ and x_.
  void begin(const Equations& its) const;
  /// Takes an unknown out of the equations in factor_ and x_, as 0.
  void hold(int row) const;
  static double product(const Moments& moments, double offset_a, double offset_b);
  double target(int term, double offset_px) const;

  int terms_;
  bool joint_;
  double constant_ = 0;
  std::vector<Moments> quadratic_;  ///< per pair of terms: AxisError::pair_of
  std::vector<Moments> linear_;     ///< per term
  mutable MatrixXd factor_;         ///< these three are kept by change() for the next time
  mutable VectorXd x_;
  mutable std::vector<int> held_;
};

QuadraticForm::QuadraticForm(const ChannelOnPixels& channel, const Responses& beta, const VectorXd& sums, bool joint,
                             bool searches)
    : terms_(channel.terms()), joint_(joint) {
  const PowerGrid& grid = channel.grid();
  const AxisError error = channel.axis_error(beta);
  // The response of the centre alone, less the model's.
  const MatrixXd rest = (-channel.model()).rowwise() + sums.transpose();
  const MatrixXd quadratic = grid.to_fine(error.quadratic);
  const MatrixXd linear_of_model =
      joint ? grid.to_fine(error.linear) : MatrixXd(MatrixXd::Zero(rest.rows(), rest.cols()));
  VectorXd constant = joint ? VectorXd(grid.to_fine(error.constant)) : VectorXd(VectorXd::Zero(rest.rows()));
  for (int t = 0; t < terms_; ++t) {
    VectorXd linear = linear_of_model.col(t);
    for (int other = 0; other < terms_; ++other) {
      if (!joint && other != t) continue;
      linear -= quadratic.col(AxisError::pair_of(t, other)).cwiseProduct(rest.col(other));
    }
    constant -= rest.col(t).cwiseProduct(linear_of_model.col(t) + linear);
    linear_.push_back(Moments::of_fine(grid, std::move(linear), searches));
  }
  for (Index pair = 0; pair < error.quadratic.cols(); ++pair) {
    quadratic_.push_back(Moments::of_coarse(grid, error.quadratic.col(pair)));
  }
  constant_ = constant.dot(grid.fine.weight);
}

double QuadraticForm::target(int term, double offset_px) const {
  const Moments& moments = linear_[term];
  double sum = 0;
  for (const auto& [k, share] : pixels_of(offset_px)) {
    if (share > 0) sum += share * 2 * (moments[k] - moments[0]);
  }
  return sum;
}

double QuadraticForm::product(const Moments& moments, double offset_a, double offset_b) {
  const auto of_pixels = [&](int k, int l) {
    return 2 * (moments[k + l] + moments[std::abs(k - l)]) - 4 * (moments[k] + moments[l] - moments[0]);
  };
  const auto a = pixels_of(offset_a);
  const auto b = pixels_of(offset_b);
  if (a[1].share == 0 && b[1].share == 0) return of_pixels(a[0].offset_px, b[0].offset_px);
  double sum = 0;
  for (const auto& [k, share_k] : a) {
    for (const auto& [l, share_l] : b) {
      if (share_k != 0 && share_l != 0) sum += share_k * share_l * of_pixels(k, l);
    }
  }
  return sum;
}

/// Makes the lower half of a matrix its Cholesky factor, with the reciprocals of the pivots in the diagonal: 0 where
/// rounding has left nothing. Eigen's takes several times as long for matrices this small.
void factorise(MatrixXd& matrix) {
  constexpr Index panel = 4;  // so many columns are taken from the later ones at once
  const Index size = matrix.rows();
  for (Index first = 0; first < size; first += panel) {
    const Index end = std::min(first + panel, size);
    for (Index k = first; k < end; ++k) {
      double* const column = matrix.col(k).data();
      column[k] = column[k] > 0 ? 1 / std::sqrt(column[k]) : 0;
      const double over_pivot = column[k];
      for (Index row = k + 1; row < size; ++row) column[row] *= over_pivot;
      for (Index j = k + 1; j < end; ++j) {
        double* const later = matrix.col(j).data();
        const double factor = column[j];
        for (Index row = j; row < size; ++row) later[row] -= factor * column[row];
      }
    }
    if (end == size) break;
    const double* const a = matrix.col(first).data();
    const double* const b = a + size;
    const double* const c = b + size;
    const double* const d = c + size;
    for (Index j = end; j < size; ++j) {
      double* const later = matrix.col(j).data();
      const double by_a = a[j];
      const double by_b = b[j];
      const double by_c = c[j];
      const double by_d = d[j];
      for (Index row = j; row < size; ++row) {
        later[row] -= by_a * a[row] + by_b * b[row] + by_c * c[row] + by_d * d[row];
      }
    }
  }
}

/// The factor divides x, and its transpose does: the one after the other takes a right side to the solution.
void divide_by_factor(const MatrixXd& factor, VectorXd& x) {
  const Index size = x.size();
  for (Index k = 0; k < size; ++k) {
    const double* const column = factor.col(k).data();
    const double its = x[k] * column[k];
    x[k] = its;
    for (Index row = k + 1; row < size; ++row) x[row] -= its * column[row];
  }
}

void divide_by_transpose(const MatrixXd& factor, VectorXd& x) {
  for (Index k = x.size() - 1; k >= 0; --k) {
    const Index later = x.size() - 1 - k;
    x[k] = (x[k] - factor.col(k).tail(later).dot(x.tail(later))) * factor(k, k);
  }
}

std::vector<Equations> QuadraticForm::equations(const std::vector<double>& offsets_px) const {
  const auto size = static_cast<Index>(offsets_px.size()) * (joint_ ? terms_ : 1);
  std::vector<Equations> result(joint_ ? 1 : terms_, {MatrixXd(size, size), VectorXd(size)});
  // The later one of two pairs fills what belongs to both.
  for (std::size_t pair = 0; pair < offsets_px.size(); ++pair) fill(result, offsets_px, pair, pair + 1);
  return result;
}

void QuadraticForm::move(std::vector<Equations>& equations, const std::vector<double>& offsets_px,
                         std::size_t pair) const {
  fill(equations, offsets_px, pair, offsets_px.size());
}

void QuadraticForm::fill(std::vector<Equations>& equations, const std::vector<double>& offsets_px, std::size_t pair,
                         std::size_t others) const {
  const auto pairs = static_cast<Index>(offsets_px.size());
  const auto place = static_cast<Index>(pair);
  for (int t = 0; t < terms_; ++t) {
    Equations& its = equations[joint_ ? 0 : t];
    const Index row = (joint_ ? t * pairs : 0) + place;
    its.right[row] = target(t, offsets_px[pair]);
    for (int other = joint_ ? 0 : t; other <= t; ++other) {
      const Moments& moments = quadratic_[AxisError::pair_of(t, other)];
      const Index start = joint_ ? other * pairs : 0;
      for (Index i = 0; i < static_cast<Index>(others); ++i) {
        const double value = product(moments, offsets_px[pair], offsets_px[i]);
        its.matrix(std::max(row, start + i), std::min(row, start + i)) = value;
        // The terms the other way round.
        if (other < t) its.matrix(row - place + i, start + place) = value;
      }
    }
  }
}

double QuadraticForm::solve(const std::vector<Equations>& equations, const std::vector<bool>& non_negative,
                            MatrixXd* weights) const {
  if (weights != nullptr) weights->setZero(equations[0].right.size() / (joint_ ? terms_ : 1), terms_);
  double value = constant_;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    value += change(equations[i], static_cast<int>(i), non_negative, weights);
  }
  return value;
}

double QuadraticForm::change(const Equations& its, int first, const std::vector<bool>& non_negative,
                             MatrixXd* weights) const {
  const auto size = static_cast<int>(its.right.size());
  const int pairs = size / (joint_ ? terms_ : 1);
  held_.clear();
  for (;;) {
    begin(its);
    for (const int row : held_) hold(row);
    factorise(factor_);
    divide_by_factor(factor_, x_);
    divide_by_transpose(factor_, x_);
    // A weight that would be below 0 is held there, one after the other.
    int worst = -1;
    for (int row = 0; row < size; ++row) {
      if (x_[row] < 0 && non_negative[first + row / pairs] && (worst < 0 || x_[row] < x_[worst])) worst = row;
    }
    if (worst < 0) break;
    held_.push_back(worst);
  }
  if (weights != nullptr) {
    for (int row = 0; row < size; ++row) (*weights)(row % pairs, first + row / pairs) = x_[row];
  }
  return -its.right.dot(x_);
}

double QuadraticForm::bound(const std::vector<Equations>& equations) const {
  double value = constant_;
  for (const Equations& its : equations) {
    begin(its);
    factorise(factor_);
    divide_by_factor(factor_, x_);
    value -= x_.squaredNorm();
  }
  return value;
}

void QuadraticForm::begin(const Equations& its) const {
  // A term of no or little scale must not grow without bound.
  constexpr double ridge = 1e-11;
  factor_ = its.matrix;
  factor_.diagonal().array() += ridge * its.matrix.diagonal().maxCoeff() + std::numeric_limits<double>::min();
  x_ = its.right;
}

void QuadraticForm::hold(int row) const {
  factor_.row(row).head(row).setZero();
  factor_.col(row).tail(factor_.rows() - row).setZero();
  factor_(row, row) = 1;
  x_[row] = 0;
}

using Forms = std::vector<QuadraticForm>;

double least_error(const Forms& forms, const std::vector<double>& offsets_px, const std::vector<bool>& non_negative) {
  double sum = 0;
  for (const QuadraticForm& form : forms) sum += form.solve(offsets_px, non_negative, nullptr);
  return sum;
}

/// Positions of taps, and the least error with them.
class Positions {
 public:
  Positions(const Forms& forms, const std::vector<bool>& non_negative, int farthest_px, double gap_px,
            std::vector<double> offsets_px)
      : forms_(forms),
        non_negative_(non_negative),
        farthest_px_(farthest_px),
        gap_px_(gap_px),
        offsets_px_(std::move(offsets_px)) {
    for (const QuadraticForm& form : forms_) {
      equations_.push_back(form.equations(offsets_px_));
      error_ += form.solve(equations_.back(), non_negative_, nullptr);
    }
    moved_equations_ = equations_;
  }

  double error() const { return error_; }
  const std::vector<double>& offsets_px() const { return offsets_px_; }

  /// Moves one tap after the other by a step to either side where that helps, until it helps nowhere.
  void move_each(double step_px) {
    std::size_t left = offsets_px_.size();  // taps that have not been tried since the last move
    for (std::size_t i = 0; left > 0; i = (i + 1) % offsets_px_.size()) {
      left = move(i, -step_px) || move(i, step_px) ? offsets_px_.size() : left - 1;
    }
  }

 private:
  bool move(std::size_t i, double by_px) {
    constexpr double worthwhile = 1 - 1e-4;
    const double before = offsets_px_[i];
    const double after = before + by_px;
    const double low = (i == 0 ? 0 : offsets_px_[i - 1]) + gap_px_;
    const double high = i + 1 < offsets_px_.size() ? offsets_px_[i + 1] - gap_px_ : farthest_px_;
    if (after < low || after > high) return false;
    offsets_px_[i] = after;
    double error_after = 0;
    const auto is_worthwhile = [&] { return error_after < error_ * worthwhile; };
    // No channel has an error below 0.
    for (std::size_t c = 0; c < forms_.size() && is_worthwhile(); ++c) {
      moved_equations_[c] = equations_[c];
      forms_[c].move(moved_equations_[c], offsets_px_, i);
      error_after += forms_[c].bound(moved_equations_[c]);
    }
    if (is_worthwhile()) {
      error_after = 0;
      for (std::size_t c = 0; c < forms_.size(); ++c) {
        error_after += forms_[c].solve(moved_equations_[c], non_negative_, nullptr);
      }
    }
    if (is_worthwhile()) {
      error_ = error_after;
      std::swap(equations_, moved_equations_);
      return true;
    }
    offsets_px_[i] = before;
    return false;
  }

  const Forms& forms_;
  const std::vector<bool>& non_negative_;
  double farthest_px_;
  double gap_px_;  ///< least distance of two taps
  std::vector<double> offsets_px_;
  std::vector<std::vector<Equations>> equations_;        ///< per channel
  std::vector<std::vector<Equations>> moved_equations_;  ///< where a move is tried
  double error_ = 0;
};

/// Moves one tap after the other by a step as long as that helps, with ever smaller steps. Returns the error.
double search(const Forms& forms, std::vector<double>& offsets_px, int farthest_px, double first_step_px,
              double last_step_px, const std::vector<bool>& non_negative) {
  constexpr double least_gap_px = 0.25;
  Positions positions(forms, non_negative, farthest_px, last_step_px >= 1 ? 1 : least_gap_px, offsets_px);
  const int halvings = static_cast<int>(std::log2(first_step_px / last_step_px));
  for (int i = 0; i <= halvings; ++i) positions.move_each(std::ldexp(first_step_px, -i));
  offsets_px = positions.offsets_px();
  return positions.error();
}

/// The given offsets and others whose distances grow exponentially, the most promising first.
std::vector<std::vector<double>> starts(const Forms& forms, const std::vector<double>& given_px, int farthest_px,
                                        Fetch fetch, const std::vector<bool>& non_negative) {
  std::vector<std::pair<double, std::vector<double>>> all = {{least_error(forms, given_px, non_negative), given_px}};
  const auto pairs = static_cast<int>(given_px.size());
  for (const double growth : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    for (double reach_px = farthest_px; reach_px > pairs && reach_px > 0.15 * farthest_px; reach_px *= 0.85) {
      std::vector<double> offsets_px;
      for (int i = 1; i <= pairs; ++i) {
        double offset_px = reach_px * std::expm1(growth * i / pairs) / std::expm1(growth);
        if (fetch == Fetch::integer) offset_px = std::round(offset_px);
        offsets_px.push_back(std::max(offset_px, (offsets_px.empty() ? 0 : offsets_px.back()) + 1));
      }
      if (offsets_px.back() > farthest_px) continue;
      all.emplace_back(least_error(forms, offsets_px, non_negative), std::move(offsets_px));
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<std::vector<double>> result;
  result.reserve(all.size());
  for (auto& [error, offsets_px] : all) result.push_back(std::move(offsets_px));
  return result;
}

/// The weights of the centre and of a tap of each pair, a column a term, that have these sums.
MatrixXd solved_weights(const QuadraticForm& form, const std::vector<double>& offsets_px,
                        const std::vector<bool>& non_negative, const VectorXd& sums) {
  MatrixXd pairs;
  form.solve(offsets_px, non_negative, &pairs);
  MatrixXd all(pairs.rows() + 1, pairs.cols());
  all.bottomRows(pairs.rows()) = pairs;
  all.row(0) = sums.transpose() - 2 * pairs.colwise().sum();
  for (Index t = 0; t < all.cols(); ++t) {
    // The pairs are not negative, but may leave less than nothing for the centre.
    const double least_centre = 1e-5 * sums[t];
    if (!non_negative[static_cast<std::size_t>(t)] || all(0, t) >= least_centre) continue;
    all.col(t) *= (sums[t] - least_centre) / (sums[t] - all(0, t));
    all(0, t) = least_centre;
  }
  return all;
}

}  // namespace

Responses responses_of(const PlacedTaps& taps, int channel, const PowerGrid& grid) {
  const MatrixXd& weights = taps.weights[channel];
  Responses responses(grid.fine.size(), weights.cols());
  for (Index t = 0; t < weights.cols(); ++t) {
    VectorXd row = VectorXd::Zero(grid.fine.size());
    row[0] = weights(0, t);
    for (std::size_t i = 0; i < taps.offsets_px.size(); ++i) {
      for (const auto& [k, share] : pixels_of(taps.offsets_px[i])) {
        // Both taps of a pair reach the centre pixel.
        if (share > 0) row[k] += weights(static_cast<Index>(i) + 1, t) * share * (k == 0 ? 2 : 1);
      }
    }
    responses.col(t) = grid.response(row);
  }
  return responses;
}

PlacedTaps fit_taps(const std::array<ChannelOnPixels, 3>& channels, std::vector<double> offsets_px, Search how,
                    int farthest_px, Fetch fetch, bool joint, const std::vector<bool>& non_negative,
                    const std::array<VectorXd, 3>& sums) {
  PlacedTaps taps{std::move(offsets_px), {}};
  std::array<Responses, 3> beta;
  for (int c = 0; c < 3; ++c) beta[c] = channels[c].model();
  const auto forms = [&](bool searches) {
    Forms result;
    for (int c = 0; c < 3; ++c) result.emplace_back(channels[c], beta[c], sums[c], joint, searches);
    return result;
  };
  const auto weigh = [&](const Forms& its_forms, double share_of_new) {
    for (int c = 0; c < 3; ++c) {
      const MatrixXd all = solved_weights(its_forms[c], taps.offsets_px, non_negative, sums[c]);
      taps.weights[c] = share_of_new == 1 ? all : MatrixXd(share_of_new * all + (1 - share_of_new) * taps.weights[c]);
      beta[c] = responses_of(taps, c, channels[c].grid());
    }
  };
  // The other axis first has the model's response, then that of the taps found so far.
  const double last_step_px = fetch == Fetch::linear ? 1.0 / 32 : 1;
  const Forms first_forms = forms(how != Search::nowhere);
  std::vector<std::vector<double>> candidates = {taps.offsets_px};
  if (how == Search::everywhere) candidates = starts(first_forms, taps.offsets_px, farthest_px, fetch, non_negative);
  constexpr std::size_t most_candidates = 10;
  candidates.resize(std::min(candidates.size(), most_candidates));
  const double first_step_px = std::max(1.0, std::exp2(std::floor(std::log2(candidates[0].back() / 16))));
  double least = HUGE_VAL;
  if (how == Search::nowhere) candidates.clear();
  for (std::vector<double>& offsets : candidates) {
    const double error = search(first_forms, offsets, farthest_px, first_step_px, last_step_px, non_negative);
    if (error < least) {
      least = error;
      taps.offsets_px = offsets;
    }
  }
  weigh(first_forms, 1);
  const int more_searches = how == Search::everywhere ? 2 : how == Search::nearby ? 1 : 0;
  for (int i = 0; i < more_searches; ++i) {
    const Forms its_forms = forms(true);
    search(its_forms, taps.offsets_px, farthest_px, std::min(first_step_px, 4.0), last_step_px, non_negative);
    weigh(its_forms, 1);
  }
  // Both axes have the same weights: halfway steps settle where neither gains by a change.
  if (joint) {
    const int settling_steps = how == Search::everywhere ? 6 : 3;
    for (int i = 0; i < settling_steps; ++i) weigh(forms(false), 0.5);
  }
  return taps;
}

}  // namespace dermis
