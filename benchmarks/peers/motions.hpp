#pragma once

#include "../odeint_peer.hpp"
#include "motion.hpp"

#include "graze/model/microbeam.hpp"

#include <cstddef>
#include <memory>

namespace peers {

/// The same motion in double and long double precision.
struct Motions {
    std::unique_ptr<Motion<double>> motion;
    std::unique_ptr<Motion<long double>> exact;
};

/// See the headers chain_motion, beam_motion and testbed_motion.
Motions chain_motions(std::size_t oscillators, double force);
Motions beam_motions(const graze::MicrobeamOptions& options);
Motions testbed_motions(const OdeintPeer::Parameters& groups);

} // namespace peers
