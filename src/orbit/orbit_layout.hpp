#pragma once

#include <cstddef>
#include <vector>

namespace graze {

/// Positions of the unknowns of an orbit's equations. Each segment is split into pieces, each with a start and a
/// duration:
///
///     (x_0, T_0, x_1, T_1, ..., inner unknowns, free parameters).
///
/// Inner unknowns are states within the pieces, as in collocation; shooting has none.
class OrbitLayout {
public:
    /// @param counts number of pieces of each segment, at least one; @param inner number of inner unknowns of each
    /// piece
    OrbitLayout(std::size_t states, const std::vector<std::size_t>& counts, std::size_t inner, std::size_t free)
        : states_(states), inner_(inner), free_(free) {
        for (const std::size_t count : counts) {
            first_.push_back(segments_.size());
            segments_.insert(segments_.end(), count, first_.size() - 1);
        }
    }

    std::size_t states() const { return states_; }
    std::size_t segments() const { return first_.size(); }
    std::size_t pieces() const { return segments_.size(); }
    std::size_t inner() const { return inner_; } ///< of each piece
    std::size_t free() const { return free_; }
    std::size_t unknowns() const { return parameter(free_); }

    std::size_t start_of(std::size_t piece) const { return piece * (states_ + 1); }
    std::size_t duration_of(std::size_t piece) const { return start_of(piece) + states_; }
    std::size_t inner_of(std::size_t piece) const { return start_of(pieces()) + piece * inner_; }
    std::size_t parameter(std::size_t index) const { return inner_of(pieces()) + index; }

    std::size_t segment_of(std::size_t piece) const { return segments_[piece]; }
    std::size_t first_piece(std::size_t segment) const { return first_[segment]; }
    /// The piece that ends with the end of the segment.
    std::size_t last_piece(std::size_t segment) const {
        return (segment + 1 < first_.size() ? first_[segment + 1] : pieces()) - 1;
    }
    bool is_last(std::size_t piece) const { return last_piece(segments_[piece]) == piece; }

private:
    std::size_t states_, inner_, free_;
    std::vector<std::size_t> first_, segments_;
};

} // namespace graze
