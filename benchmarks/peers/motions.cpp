#include "motions.hpp"

#include "beam_motion.hpp"
#include "chain_motion.hpp"
#include "testbed_motion.hpp"

namespace peers {

namespace {

template <template <class> class Kind, class... Arguments>
Motions both(const Arguments&... arguments) {
    return {std::make_unique<Kind<double>>(arguments...), std::make_unique<Kind<long double>>(arguments...)};
}

} // namespace

Motions chain_motions(std::size_t oscillators, double force) {
    return both<ChainMotion>(oscillators, force);
}

Motions beam_motions(const graze::MicrobeamOptions& options) {
    return both<BeamMotion>(options);
}

Motions testbed_motions(const OdeintPeer::Parameters& groups) {
    return both<TestbedMotion>(groups);
}

} // namespace peers
