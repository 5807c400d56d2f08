#pragma once

#include "orbit/orbit_equations.hpp"

namespace graze {

/// The equations of an orbit by collocation. On each of the equal intervals of a segment the motion is a polynomial
/// that satisfies the differential equations at the four Gauss points (C. de Boor and B. Swartz, "Collocation at
/// Gaussian points", SIAM J. Numer. Anal. 10, 1973); its values there are the inner unknowns. Errors at the ends of
/// intervals fall with the eighth power of the interval length. Collocation shares only the treatment of segment ends
/// with Shooting, so agreement of the two is an independent check.
///
/// The inner unknowns are eliminated segment by segment, as in AUTO (E. J. Doedel, H. B. Keller and J. P. Kernevez
/// 1991).
class Collocation : public OrbitEquations {
public:
    static constexpr std::size_t points = 4;

    /// @param intervals number of equal intervals of each segment
    /// @throws InputError when the orbit does not fit the model, or there are no intervals
    Collocation(const Simulation& simulation, const Orbit& orbit, std::vector<ParameterId> free, std::size_t intervals,
                std::vector<double> ranges = {});

private:
    /// Rates of a mode with their derivatives, and which states are constant in it.
    struct Rates {
        std::vector<Function> functions;
        std::vector<bool> constant;
    };

    bool follow(std::size_t piece, const Eigen::VectorXd& unknowns, OrbitEvaluation& at) override;
    void set_inner(const Orbit& orbit, Eigen::VectorXd& unknowns) override;
    void rates_at(const Rates& rates, const double* state, const OrbitEvaluation& at, Eigen::VectorXd& values,
                  Eigen::MatrixXd& derivatives);

    std::size_t intervals_;
    std::vector<Rates> rates_; ///< of each segment
    std::vector<double> inputs_, work_, values_;
};

} // namespace graze
