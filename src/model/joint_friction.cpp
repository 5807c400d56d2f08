#include "model/joint_friction.hpp"

#include "base/linear_systems.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/expression_matrix.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

namespace graze {

namespace {

constexpr double zero_share = 1e-9; ///< of numbers that are of the order of one

/// The inequality fixed + sum(by * chosen) >= 0.
struct Row {
    std::size_t contact = 0;
    ContactState beyond = ContactState::open;
    Expression fixed{}, squares{}; ///< and those of the terms of `fixed`
    std::vector<Expression> by{};
    std::vector<double> at_start{};
};

using Numbers = std::vector<std::vector<double>>;

double determinant_of(const Numbers& rows) {
    const auto n = static_cast<Eigen::Index>(rows.size());
    return determinant(Eigen::MatrixXd::NullaryExpr(n, n, [&](Eigen::Index i, Eigen::Index j) {
        return rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }));
}

std::vector<std::size_t> members(std::size_t set) {
    std::vector<std::size_t> result;
    for (std::size_t i = 0; set >> i != 0; ++i)
        if ((set >> i & 1U) != 0)
            result.push_back(i);
    return result;
}

/// Returns all sets of `size` of the first n numbers, as bits.
std::vector<std::size_t> sets(std::size_t n, std::size_t size) {
    std::vector<std::size_t> result;
    for (std::size_t set = 0; set < std::size_t{1} << n; ++set)
        if (static_cast<std::size_t>(std::popcount(set)) == size)
            result.push_back(set);
    return result;
}

class LimitFinder {
public:
    LimitFinder(const StartValues& start, const std::vector<SharedContact>& contacts)
        : start_(start), one_(contacts.front().normal.fixed.graph()->number(1)), contacts_(contacts),
          chosen_(contacts.front().normal.by.size()) {
        for (const SharedContact& one : contacts)
            add_rows(one);
        note_start();
    }

    JointLimits run() {
        JointLimits result;
        std::vector<std::size_t> found;
        for (std::size_t size = 1; size <= chosen_ + 1; ++size)
            for (const std::size_t set : sets(rows_.size(), size)) {
                const auto contains = [&](std::size_t smaller) { return (set & smaller) == smaller; };
                if (std::ranges::none_of(found, contains) && cancels(members(set))) {
                    found.push_back(set);
                    result.limits.push_back(limit_of(members(set)));
                }
            }
        for (const std::size_t set : sets(rows_.size(), chosen_)) {
            ExpressionMatrix symbols;
            Numbers numbers;
            for (const std::size_t row : members(set)) {
                symbols.push_back(rows_[row].by);
                numbers.push_back(scaled_[row]);
            }
            const Expression minor = determinant(symbols, one_);
            if (const double value = determinant_of(numbers); std::abs(value) > zero_share && !minor.is_number())
                result.regular.push_back(value > 0 ? minor : -minor);
        }
        return result;
    }

private:
    void add_rows(const SharedContact& one) {
        if (!one.sticks) {
            rows_.push_back(
                {one.contact, ContactState::open, one.normal.fixed, pow(one.normal.fixed, 2), one.normal.by});
            return;
        }
        for (const ContactState beyond : {ContactState::forward, ContactState::backward}) {
            const bool forward = beyond == ContactState::forward;
            const auto row = [&](const Expression& normal, const Expression& tangential) {
                return forward ? one.friction * normal + tangential : one.friction * normal - tangential;
            };
            Row& made = rows_.emplace_back(Row{one.contact, beyond, row(one.normal.fixed, one.tangential.fixed),
                                               pow(one.friction * one.normal.fixed, 2) + pow(one.tangential.fixed, 2)});
            for (std::size_t k = 0; k < chosen_; ++k)
                made.by.push_back(row(one.normal.by[k], one.tangential.by[k]));
        }
    }

    /// Evaluates the coefficients at the initial state, with columns and rows scaled to the order of one.
    void note_start() {
        std::vector<double> columns(chosen_, 0.0);
        for (Row& row : rows_) {
            row.at_start = start_.of(row.by);
            for (std::size_t k = 0; k < chosen_; ++k)
                columns[k] = std::max(columns[k], std::abs(row.at_start[k]));
        }
        for (const Row& row : rows_) {
            std::vector<double> scaled = row.at_start;
            double greatest = 0;
            for (std::size_t k = 0; k < chosen_; ++k) {
                scaled[k] /= columns[k] > 0 ? columns[k] : 1;
                greatest = std::max(greatest, std::abs(scaled[k]));
            }
            for (double& value : scaled)
                value /= greatest > zero_share ? greatest : 1;
            scaled_.push_back(std::move(scaled));
        }
    }

    /// Returns whether a combination of these rows, with positive factors that are unique, has no chosen force.
    bool cancels(const std::vector<std::size_t>& rows) const {
        const std::size_t m = rows.size();
        Numbers equations(chosen_); // one for each chosen force, in the factors
        for (std::size_t k = 0; k < chosen_; ++k)
            for (const std::size_t row : rows)
                equations[k].push_back(scaled_[row][k]);
        std::vector<double> factors(m, 1.0);
        std::size_t rank = 0;
        for (; rank + 1 < m; ++rank) { // the last factor is one
            std::size_t pivot = rank;
            for (std::size_t k = rank; k < chosen_; ++k)
                if (std::abs(equations[k][rank]) > std::abs(equations[pivot][rank]))
                    pivot = k;
            if (!(std::abs(equations[pivot][rank]) > zero_share))
                return false;
            std::swap(equations[pivot], equations[rank]);
            for (std::size_t k = 0; k < chosen_; ++k)
                if (const double factor = equations[k][rank] / equations[rank][rank]; k != rank)
                    for (std::size_t j = rank; j < m; ++j)
                        equations[k][j] -= factor * equations[rank][j];
        }
        for (std::size_t k = rank; k < chosen_; ++k)
            if (std::abs(equations[k][m - 1]) > zero_share)
                return false;
        for (std::size_t k = 0; k < rank; ++k)
            if (!(-equations[k][m - 1] / equations[k][k] > zero_share))
                return false;
        return true;
    }

    const SharedContact& of(std::size_t row) const {
        return *std::ranges::find(contacts_, rows_[row].contact, &SharedContact::contact);
    }

    /// The combination is a determinant. Both limits of one contact together are the tip of its cone, where it has no
    /// force: its normal and its tangential force have the same determinant but for the coefficient of friction, which
    /// may be zero.
    ContactLimit limit_of(const std::vector<std::size_t>& rows) const {
        ContactLimit result;
        ExpressionMatrix matrix; // fixed parts, then coefficients
        std::vector<Expression> squares;
        Numbers numbers;
        std::size_t positive = 0; // a row with a positive factor
        const auto add = [&](const Expression& fixed, const Expression& square, const std::vector<Expression>& by) {
            squares.push_back(square);
            matrix.push_back({fixed});
            matrix.back().insert(matrix.back().end(), by.begin(), by.end());
            numbers.push_back(start_.of(by));
        };
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const SharedContact& one = of(rows[k]);
            const bool both = k + 1 < rows.size() && rows_[rows[k + 1]].contact == one.contact;
            if (both) {
                positive = matrix.size();
                add(one.normal.fixed, pow(one.normal.fixed, 2), one.normal.by);
                add(one.tangential.fixed, pow(one.tangential.fixed, 2), one.tangential.by);
                ++k;
            } else {
                add(rows_[rows[k]].fixed, rows_[rows[k]].squares, rows_[rows[k]].by);
            }
            result.beyond.emplace_back(one.contact, both ? ContactState::open : rows_[rows[k]].beyond);
        }
        std::optional<double> best;
        for (const std::size_t columns : sets(chosen_, rows.size() - 1)) {
            ExpressionMatrix part;
            Numbers others;
            for (std::size_t i = 0; i < matrix.size(); ++i) {
                part.push_back({matrix[i].front()});
                std::vector<double> row;
                for (const std::size_t column : members(columns)) {
                    part.back().push_back(matrix[i][column + 1]);
                    row.push_back(numbers[i][column]);
                }
                if (i != positive)
                    others.push_back(std::move(row));
            }
            const double factor = (positive % 2 == 0 ? 1 : -1) * determinant_of(others);
            if (best && std::abs(factor) <= *best)
                continue;
            best = std::abs(factor);
            const Expression combination = determinant(part, one_);
            result.function = factor >= 0 ? combination : -combination;
            result.squares = one_.graph()->number(0);
            for (std::size_t i = 0; i < part.size(); ++i) {
                ExpressionMatrix minor;
                for (std::size_t k = 0; k < part.size(); ++k)
                    if (k != i)
                        minor.emplace_back(part[k].begin() + 1, part[k].end());
                result.squares = result.squares + squares[i] * pow(determinant(minor, one_), 2);
            }
        }
        return result;
    }

    const StartValues& start_;
    Expression one_;
    const std::vector<SharedContact>& contacts_;
    std::size_t chosen_;
    std::vector<Row> rows_;
    Numbers scaled_;
};

} // namespace

JointLimits joint_limits(const StartValues& start, const std::vector<SharedContact>& contacts) {
    return contacts.empty() ? JointLimits{} : LimitFinder(start, contacts).run();
}

} // namespace graze
