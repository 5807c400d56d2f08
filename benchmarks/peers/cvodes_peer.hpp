#pragma once

#include "motion.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace peers {

/// A surface that was reached.
struct Meeting {
    double time = 0;
    std::size_t mode = 0, surface = 0;
};

/// The integration method of CVODES.
struct CvodesMethod {
    bool stiff = false; ///< backward differences and Newton's method, rather than Adams's with fixed points
    bool staggered = false;
    std::string name() const {
        return std::string(stiff ? "BDF" : "Adams") + (staggered ? ", staggered" : ", simultaneous");
    }
};

/// CVODES with forward sensitivities, all under error control, and root finding for the surfaces.
class CvodesPeer {
public:
    /// @param motion must outlive this
    /// @param state_scales, input_scales sizes of states, and of states and parameter, for absolute tolerances
    /// @param derivatives true: compute derivatives with respect to all states and the parameter
    CvodesPeer(const Motion<double>& motion, std::vector<double> state_scales, std::vector<double> input_scales,
               CvodesMethod method, double tolerance, bool derivatives);
    ~CvodesPeer();
    CvodesPeer(CvodesPeer&&) noexcept;

    void run(const std::vector<double>& start, std::size_t mode, double end);
    const std::vector<double>& state() const;
    /// Of the state, [input * states + state].
    const std::vector<double>& derivatives() const;
    const std::vector<Meeting>& meetings() const;
    long steps() const;

private:
    class Integrator;
    std::unique_ptr<Integrator> integrator_;
};

} // namespace peers
