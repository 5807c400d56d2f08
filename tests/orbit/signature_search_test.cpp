// Search for orbits with a given signature.

#include "base/message_of.hpp"
#include "graze/model/catalogue.hpp"
#include "graze/orbit/solve.hpp"
#include "trajectory/model_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace graze::signature_search_test {

using namespace graze::testing;

std::string refusal(const Model& model, const std::string& signature, const SignatureSearchOptions& search = {}) {
    return message_of([&] { orbit_with_signature(System(model), parse_signature(model, signature), {}, {}, search); });
}

TEST(OrbitWithSignature, IdentityTransitionsAndSectionsCountWhereTheSignatureNamesThem) {
    const Model model = shipped_with("impact-microactuator", {{"V", 0.2}});
    OrbitSolution at_section;
    for (const char* signature : {"J5", "phase0", "longest", "J5 phase0"}) {
        const auto found = orbit_with_signature(System(model), parse_signature(model, signature));
        ASSERT_TRUE(found) << signature;
        ASSERT_EQ(found->outcome, OrbitOutcome::converged) << signature << ' ' << found->detail;
        EXPECT_EQ(to_string(model, found->orbit.signature), signature);
        EXPECT_TRUE(found->certificate.admissible) << found->certificate.reason;
        if (at_section.orbit.starts.empty())
            at_section = *found;
        EXPECT_NEAR(found->orbit.period(), at_section.orbit.period(), 1e-9);
        ASSERT_EQ(found->multipliers.size(), at_section.multipliers.size());
        EXPECT_NEAR(std::abs(found->multipliers[0]), std::abs(at_section.multipliers[0]), 1e-9);
    }
}

TEST(OrbitWithSignature, SearchIsBoundedAndCanBeInterrupted) {
    Model model = load_model("impact-microactuator");
    model.set_parameter("V", 0.2); // no impacts
    SignatureSearchOptions search;
    search.steps = 20000;
    EXPECT_NE(refusal(model, "J1 J8", search).find("does not have the signature 'J1 J8'"), std::string::npos);
    search.steps = 100'000'000;
    int asked = 0;
    search.interrupted = [&] { return ++asked > 20; };
    EXPECT_FALSE(orbit_with_signature(System(model), parse_signature(model, "J1 J8"), {}, {}, search));
}

TEST(OrbitWithSignature, InadmissibleOrbitsAreRefusedUnlessAllowed) {
    // Far below resonance the equations have a solution with one impact per period, but it penetrates the stop.
    Model model = shipped_with("impact-oscillator", {{"sigma", 0.5}});
    for (const double omega : {0.25, 0.35, 0.45}) {
        model.set_parameter("omega", omega);
        EXPECT_NE(refusal(model, "impact").find("is not admissible: event 'stop' happens within segment 1"),
                  std::string::npos);
        SignatureSearchOptions search;
        search.unphysical = true;
        const auto found = orbit_with_signature(System(model), parse_signature(model, "impact"), {}, {}, search);
        ASSERT_TRUE(found);
        EXPECT_EQ(found->outcome, OrbitOutcome::converged);
        EXPECT_FALSE(found->certificate.admissible);
    }
}

Model lorenz(double r) {
    return OneMode{.parameters = fmt::format("s = 10\nb = '8/3'\nr = {}", r),
                   .states = "x = 50\ny = 50\nz = 349",
                   .rates = "x = 's*(y - x)', y = 'r*x - y - x*z', z = 'x*y - b*z'",
                   .more = section("level", "z - r + 1") + section("side", "x") +
                           "[symmetries.mirror]\nmap = { x = '-x', y = '-y' }"}
        .model();
}

TEST(OrbitWithSignature, SymmetricOrbitsAreReturnedAsHalfOrbits) {
    Model model = lorenz(350);
    double period = 0;
    for (const char* signature : {"level^2", "side"}) {
        const auto found = orbit_with_signature(System(model), parse_signature(model, signature));
        ASSERT_TRUE(found);
        ASSERT_EQ(found->outcome, OrbitOutcome::converged) << found->detail;
        ASSERT_TRUE(found->orbit.symmetry) << signature;
        EXPECT_EQ(found->orbit.segments(), 1U);
        if (period > 0) {
            EXPECT_NEAR(found->orbit.period(), period, 1e-11);
        }
        period = found->orbit.period();
        for (std::size_t i = 0; i < 3; ++i)
            model.set_initial(model.states[i].name, found->orbit.starts[0][i]);
        // The whole orbit has the same period and contracts volumes at the known rate.
        const OrbitSolution whole = solve_orbit(System(model), whole_orbit(System(model), found->orbit));
        ASSERT_EQ(whole.outcome, OrbitOutcome::converged) << whole.detail;
        EXPECT_NEAR(whole.orbit.period(), period, 1e-11);
        EXPECT_NEAR(std::abs(whole.multipliers[0] - found->multipliers[0]), 0, 1e-8);
        EXPECT_NEAR(std::abs(whole.multipliers[0] * whole.multipliers[1]) / std::exp(-(10 + 1 + 8.0 / 3) * period), 1,
                    1e-8);
    }
}

} // namespace graze::signature_search_test
