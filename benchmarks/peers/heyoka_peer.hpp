#pragma once

#include "../odeint_peer.hpp"

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace peers {

/// What a run of heyoka tells besides its end.
enum class HeyokaOutput {
    none,
    sections, ///< states where the voltage passes zero, found as events
    grid,     ///< the same states, at times that are known beforehand
    extrema,  ///< sections as events, and states where the displacement is largest
};

/// Choices that a careful user of heyoka would try: which is fastest depends on the processor and the tolerance.
struct HeyokaChoice {
    bool rotating_phase = false; ///< sine and cosine of the phase are states; otherwise functions of time
    bool slp_vectorize = false;  ///< of one trajectory: vectors are made of operations that are alike
    std::string name() const;
};

/// The electromagnetic vibro-impactor by heyoka, in the nondimensional form of OdeintPeer. The phase is 0 at time 0.
class HeyokaPeer {
public:
    using State = OdeintPeer::State;
    static constexpr std::size_t most_directions = 8;

    /// @param directions of derivatives: by the initial displacement, velocity, current and phase, and by voltage,
    /// damping, resistance and inductance; the first of these
    HeyokaPeer(const OdeintPeer::Parameters& groups, double tolerance, HeyokaOutput output, HeyokaChoice choice,
               std::size_t directions = 0);
    ~HeyokaPeer();
    HeyokaPeer(HeyokaPeer&&) noexcept;

    void run(const State& start, double phase, double duration);

    State state() const;
    /// Of a state by the input of a direction.
    double derivative(std::size_t state, std::size_t direction) const;
    std::size_t impacts() const;
    const std::vector<State>& passages() const;
    /// Of the last run.
    std::size_t steps() const;

private:
    class Integrator;
    std::unique_ptr<Integrator> integrator_;
};

/// The same for many voltages, in batches whose members take their own steps.
class HeyokaEnsemble {
public:
    using State = OdeintPeer::State;
    static constexpr std::size_t batch = 8;

    HeyokaEnsemble(const OdeintPeer::Parameters& groups, double tolerance, HeyokaChoice choice);
    ~HeyokaEnsemble();
    HeyokaEnsemble(HeyokaEnsemble&&) noexcept;

    /// @param voltages a multiple of `batch`
    void run(const State& start, double phase, std::span<const double> voltages, double duration);

    const std::vector<State>& states() const;
    std::size_t impacts() const;

private:
    class Integrator;
    std::unique_ptr<Integrator> integrator_;
};

} // namespace peers
