#pragma once

#include "graze/design/wish_list.hpp"
#include "orbit/eigen_index.hpp"

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// Values and gradients of all requirements at a design.
struct Evaluation {
    bool exists = false;
    Eigen::VectorXd values;   ///< in their units
    Eigen::MatrixXd gradient; ///< requirements x dimensions, in scales of the requirement per scale of the dimension
};

/// One limit of a requirement.
struct LimitRow {
    std::size_t want = 0;
    double limit = 0, sign = 1; ///< sign -1: a lower limit
    std::optional<double> cap;  ///< largest allowed violation; empty: relaxed by the elastic variable
};

/// Unit of violations of a requirement.
double scale_of(const Want& want);

/// Returns number `number` of the van der Corput sequence of a base: the coordinates of the Halton sequence, which
/// fills ranges evenly (J. H. Halton, Numer. Math. 2, 1960).
double scattered_share(std::size_t number, std::size_t base);

/// Why no more designs are evaluated.
enum class StopReason { none, interrupted, exhausted, exception };

/// The scaled problem: a design is given by its departures from the start, in scales. Counts evaluations.
class ScaledWishes {
public:
    ScaledWishes(const WishList& wishes, const WishOptions& options);

    const WishList& list() const { return wishes_; }
    const WishOptions& options() const { return options_; }
    Eigen::Index size() const { return scale_.size(); }
    const Eigen::VectorXd& lowest() const { return lowest_; }
    const Eigen::VectorXd& highest() const { return highest_; }
    std::vector<LimitRow>& rows() { return rows_; }
    const std::vector<LimitRow>& rows() const { return rows_; }

    /// Converts to unscaled values, clamped to the ranges exactly.
    std::vector<double> design(const Eigen::VectorXd& z) const;
    /// Violation of a limit in scales; negative if it is not violated.
    double violation(const LimitRow& row, const Evaluation& at) const;
    /// The largest violation of limits without a cap; 0 if none is violated.
    double largest(const Evaluation& at) const;
    /// Whether all limits with a cap respect it.
    bool keeps_caps(const Evaluation& at) const;

    /// Evaluates values and gradients at a design. @return `exists` false also if evaluation has been stopped
    const Evaluation& evaluate(const Eigen::VectorXd& z);
    bool may_go_on();

    StopReason stop_reason = StopReason::none;
    std::exception_ptr thrown;
    std::size_t evaluations = 0, missing = 0;
    std::string problem; ///< reason of the last design without all values

private:
    double scale_of(std::size_t want) const { return want_scale_[want]; }
    Evaluation values(const Eigen::VectorXd& z, std::vector<bool>& unknown);
    void complete(const Eigen::VectorXd& z, Evaluation& result, const std::vector<bool>& unknown);

    const WishList& wishes_;
    const WishOptions& options_;
    Eigen::VectorXd scale_, lowest_, highest_;
    std::vector<double> want_scale_;
    std::vector<LimitRow> rows_;
    Eigen::VectorXd last_;
    std::optional<Evaluation> evaluation_; ///< evaluation at `last_`
};

} // namespace graze
