#pragma once

#include "graze/trajectory/trajectory.hpp"
#include "sweep/section_map.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace graze {

/// The largest Lyapunov exponent from the growth of one tangent vector, from return to return of a section (Benettin
/// et al. 1980), saltation included.
class Exponent {
public:
    explicit Exponent(const SectionMap& map) : map_(&map) {}

    /// @param scale of each state, in which lengths are measured from now on
    void begin(std::span<const double> parameters, std::span<const double> scale, double time);
    bool begun() const { return begun_; }
    /// Makes a trajectory carry the vector: after `begin`, and after the trajectory has been started anew.
    void seed(Trajectory& trajectory);
    /// Takes the growth since the last return from a trajectory that stopped at one.
    void add_return(Trajectory& trajectory);

    std::size_t returns() const { return growth_.size(); }
    bool known() const;
    double value() const; ///< per unit of time
    /// Within which it lies in 19 of 20 cases: by means over batches, and by what is systematic.
    double error() const;
    double standard_error() const; ///< by means over batches alone
    /// Whether the vector's length varies between bounds, as on a torus: along a chaotic motion its variation grows
    /// like the root of time.
    bool is_bounded() const;
    /// By how much the logarithm of the vector's length departs from a steady growth.
    double variation() const { return variation(0, growth_.size()); }
    double time() const; ///< over which it is averaged
    double time_per_return() const;
    void clear() { begun_ = false; }

private:
    double growth(std::size_t first, std::size_t last) const;
    double variation(std::size_t first, std::size_t last) const;

    const SectionMap* map_;
    SectionMap::Workspace workspace_;
    std::vector<double> scale_, growth_, times_, seeds_;
    double length_ = 0, last_time_ = 0;
    std::size_t to_settle_ = 0;
    bool begun_ = false;
};

} // namespace graze
