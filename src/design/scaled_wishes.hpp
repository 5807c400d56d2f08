#pragma once

#include "graze/design/wish_list.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <exception>
#include <optional>
#include <string>
#include <vector>

namespace graze {

/// What a design has of all wants.
struct Asked {
    bool exists = false;
    Eigen::VectorXd values;   ///< in their units
    Eigen::MatrixXd gradient; ///< wants x dimensions, in scales of the want per scale of the dimension
};

/// A limit of a want.
struct LimitRow {
    std::size_t want = 0;
    double limit = 0, sign = 1; ///< sign -1: it is the lower one
    std::optional<double> cap;  ///< it may not be violated more; none: by as much as the elastic variable
};

/// The departure that counts as one.
double scale_of(const Want& want);

/// Why no more designs are asked for.
enum class Left { not_at_all, interrupted, spent, thrown };

/// The wishes in scales: a design is given by its departures from the start. Counts what is asked for.
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

    /// Within the ranges to the last bit, which scales would lose.
    std::vector<double> design(const Eigen::VectorXd& z) const;
    /// In scales; positive where the limit is violated.
    double violation(const LimitRow& row, const Asked& at) const;
    /// The largest violation of the rows that may give way; 0 where none is violated.
    double largest(const Asked& at) const;
    /// Whether no capped row is violated more than it may be.
    bool keeps_caps(const Asked& at) const;

    /// Values and gradients. @return what does not exist also where no more may be asked for
    const Asked& ask(const Eigen::VectorXd& z);
    bool may_go_on();

    Left left = Left::not_at_all;
    std::exception_ptr thrown;
    std::size_t evaluations = 0, missing = 0;
    std::string problem; ///< of the last design without all values

private:
    double scale_of(std::size_t want) const { return want_scale_[want]; }
    Asked values(const Eigen::VectorXd& z, std::vector<bool>& unknown);
    void complete(const Eigen::VectorXd& z, Asked& result, const std::vector<bool>& unknown);

    const WishList& wishes_;
    const WishOptions& options_;
    Eigen::VectorXd scale_, lowest_, highest_;
    std::vector<double> want_scale_;
    std::vector<LimitRow> rows_;
    Eigen::VectorXd last_;
    std::optional<Asked> asked_; ///< there
};

} // namespace graze
