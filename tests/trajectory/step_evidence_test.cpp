// Steps are accepted only where they are accurate: closed forms that mislead the choice of steps by last coefficients.

#include "step_evidence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace graze;
using namespace graze::testing;

namespace step_evidence_test {

/// Allowed errors: some dozen steps, each with a fraction of the tolerance, and their round-off.
constexpr double most_tolerances = 20;

struct Counts {
    long cases = 0, wrong = 0, ended = 0;
    std::string first;
};

void note(Counts& counts, long& kind, const std::string& text) {
    if (kind++ == 0)
        counts.first += text + "\n";
}

void judge_states(Counts& counts, const Family& family, Random& random, int cases_each) {
    const Model model = model_from(family.model);
    for (int digits = 6; digits <= 15; ++digits) {
        const double tolerance = std::pow(10.0, -digits);
        const Simulation simulation(System(model), {}, {}, with_tolerance(tolerance));
        for (int i = 0; i < cases_each; ++i) {
            const ClosedMotion one = family.draw(random);
            Trajectory trajectory(simulation, one.parameters);
            trajectory.start(one.state, 0, 0, one.end);
            run(trajectory);
            ++counts.cases;
            const std::string label = fmt::format("{} tolerance 1e-{} {}", family.name, digits, one.label);
            if (trajectory.outcome().ending != Ending::end_time)
                note(counts, counts.ended, label + " ended: " + trajectory.outcome().detail);
            else if (!(std::abs(trajectory.state()[one.judged] - one.exact) <=
                       most_tolerances * one.size * one.sensitivity * (tolerance + 16 * epsilon)))
                note(counts, counts.wrong,
                     fmt::format("{} gives {:.17g} for {:.17g}", label, trajectory.state()[one.judged], one.exact));
        }
    }
}

void judge_all_states(int cases_each) {
    Random random(29);
    Counts counts;
    for (const Family& family : all_families())
        judge_states(counts, family, random, cases_each);
    EXPECT_EQ(counts.wrong, 0) << counts.first;
    EXPECT_EQ(counts.ended, 0) << counts.first;
    EXPECT_GE(counts.cases, 700L * cases_each);
}

/// An event's function of s = start + t that falls through zero.
struct FallFamily {
    std::string name, function;
    /// Draws parameters k, c, a and the start; returns the time of the first fall and the function's slope there.
    std::function<void(Random&, std::vector<double>& parameters, double& start, double& time, double& slope)> draw;
};

double error_slope(double at) {
    return 2 / std::sqrt(std::numbers::pi) * std::exp(-at * at);
}

/// Newton's method from the left, where it does not overshoot. @param value from 0 to 0.95
double inverse_error_function(double value) {
    double at = 0;
    for (int i = 0; i < 50; ++i)
        at += (value - std::erf(at)) / error_slope(at);
    return at;
}

std::vector<FallFamily> fall_families() {
    std::vector<FallFamily> families;
    for (int n = 1; n <= 12; ++n)
        families.push_back({"cosine" + std::to_string(n), fmt::format("a + cos((k*s)^{})", n),
                            [n](Random& random, auto& parameters, double& start, double& time, double& slope) {
                                const double k = random.log_uniform(1e-4, 1e4), a = random.uniform(-0.9, 0.9);
                                parameters = {k, 0, a};
                                start = 0;
                                const double angle = std::acos(-a);
                                time = std::pow(angle, 1.0 / n) / k;
                                slope = n * angle / time * std::sin(angle);
                            }});
    for (const int n : {5, 13, 20, 33, 60})
        families.push_back({"power" + std::to_string(n), fmt::format("a - (k*s)^{}", n),
                            [n](Random& random, auto& parameters, double& start, double& time, double& slope) {
                                const double k = random.log_uniform(1e-4, 1e4), a = random.log_uniform(0.1, 10);
                                parameters = {k, 0, a};
                                start = random.chance(0.3) ? 0 : -0.5 * std::pow(a, 1.0 / n) / k;
                                time = std::pow(a, 1.0 / n) / k - start;
                                slope = n * a / (time + start);
                            }});
    const auto steep = [](auto offset, auto slope_at) {
        return [=](Random& random, auto& parameters, double& start, double& time, double& slope) {
            const double k = random.log_uniform(1, 1e4), c = random.uniform(-0.5, 1), a = random.uniform(1.1, 3);
            parameters = {k, c, a};
            start = -1;
            time = c - start + offset(a) / k;
            slope = k * slope_at(a);
            if (time <= 0) { // the start is after the fall
                parameters[1] = 1;
                time = 2 + offset(a) / k;
            }
        };
    };
    families.push_back(
        {"bell", "1 - a*exp(-(k*(s - c))^2)",
         steep([](double a) { return -std::sqrt(std::log(a)); }, [](double a) { return 2 * std::sqrt(std::log(a)); })});
    families.push_back(
        {"peak", "1 - a/(1 + (k*(s - c))^2)",
         steep([](double a) { return -std::sqrt(a - 1); }, [](double a) { return 2 * std::sqrt(a - 1) / a; })});
    families.push_back({"step", "1/a - tanh(k*(s - c))",
                        steep([](double a) { return std::atanh(1 / a); }, [](double a) { return 1 - 1 / (a * a); })});
    families.push_back({"error function", "1/a - erf(k*(s - c))",
                        steep([](double a) { return inverse_error_function(1 / a); },
                              [](double a) { return error_slope(inverse_error_function(1 / a)); })});
    return families;
}

void judge_falls(Counts& counts, const FallFamily& family, Random& random, int cases_each) {
    const Model model = model_from(fmt::format(R"toml(
parameters = {{ k = 1, c = 0, a = 1 }}
states = {{ s = 0 }}
events = {{ fall = "{}" }}
modes.one = {{ rates = {{ s = 1 }}, watch = ["fall"] }}
modes.two = {{ rates = {{ s = 1 }} }}
transitions = [{{ mode = "one", event = "fall", next = "two" }}]
initial = {{ mode = "one" }}
)toml",
                                               family.function));
    for (int digits = 6; digits <= 15; ++digits) {
        const double tolerance = std::pow(10.0, -digits);
        const Simulation simulation(System(model), {}, {}, with_tolerance(tolerance));
        for (int i = 0; i < cases_each; ++i) {
            std::vector<double> parameters;
            double start = 0, time = 0, slope = 0;
            family.draw(random, parameters, start, time, slope);
            Recorder recorder;
            Trajectory trajectory(simulation, parameters, borrowed(recorder));
            trajectory.start(std::vector{start}, 0, 0, 1.5 * time);
            run(trajectory);
            ++counts.cases;
            const std::string label = fmt::format("{} tolerance 1e-{} k = {} c = {} a = {} from {}", family.name,
                                                  digits, parameters[0], parameters[1], parameters[2], start);
            const double size = 1 + parameters[2];
            const double blur =
                (4 * tolerance + 64 * epsilon) * size / slope + 16 * epsilon * (time + 2 * std::abs(start));
            if (trajectory.outcome().ending != Ending::end_time)
                note(counts, counts.ended, label + " ended: " + trajectory.outcome().detail);
            else if (recorder.contacts().size() != 1 || !(std::abs(recorder.contacts()[0].contact.time - time) <= blur))
                note(counts, counts.wrong,
                     fmt::format("{}: {} contacts, at {:.17g} for {:.17g}", label, recorder.contacts().size(),
                                 recorder.contacts().empty() ? 0 : recorder.contacts()[0].contact.time, time));
        }
    }
}

void judge_all_falls(int cases_each) {
    Random random(31);
    Counts counts;
    for (const FallFamily& family : fall_families())
        judge_falls(counts, family, random, cases_each);
    EXPECT_EQ(counts.wrong, 0) << counts.first;
    EXPECT_EQ(counts.ended, 0) << counts.first;
}

TEST(StepEvidence, StatesAgreeWithClosedForms) {
    judge_all_states(8);
}
TEST(StepEvidenceSlow, StatesAgreeWithClosedForms) {
    judge_all_states(110);
}
TEST(StepEvidence, FallsAgreeWithClosedForms) {
    judge_all_falls(8);
}
TEST(StepEvidenceSlow, FallsAgreeWithClosedForms) {
    judge_all_falls(100);
}

/// x'' = -x^p from x = 0, where a short series has no nonzero coefficient of x^p; also after a jump to x = 0.
TEST(StepEvidence, SteepSpringsConserveEnergy) {
    Random random(37);
    for (int p = 3; p <= 15; p += 2) {
        const Model model = model_from(fmt::format(R"toml(
parameters = {{ period = 1 }}
states = {{ x = 0, v = 1, s = 0 }}
events = {{ due = "period - s" }}
modes.one = {{ rates = {{ x = "v", v = "-x^{0}", s = 1 }}, watch = ["due"] }}
jumps.reset = {{ x = 0, v = "sqrt(v^2 + 2*x^{1}/{1})", s = 0 }}
transitions = [{{ mode = "one", event = "due", jump = "reset", next = "one" }}]
)toml",
                                                   p, p + 1));
        for (int i = 0; i < 40; ++i) {
            const double tolerance = random.log_uniform(1e-15, 1e-6);
            const Simulation simulation(System(model), {}, {}, with_tolerance(tolerance));
            Trajectory trajectory(simulation, std::vector{random.log_uniform(0.3, 30)});
            const double speed = random.log_uniform(0.1, 10);
            trajectory.start(std::vector{0.0, speed, 0.0}, 0, 0, 20);
            run(trajectory);
            ASSERT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
            const double x = trajectory.state()[0], v = trajectory.state()[1];
            const double energy = v * v / 2 + std::pow(x, p + 1) / (p + 1), exact = speed * speed / 2;
            // Relative errors of x count p + 1 times; a few hundred steps.
            EXPECT_NEAR(energy / exact, 1,
                        (tolerance + 4 * epsilon) * (p + 1) * static_cast<double>(trajectory.steps()))
                << "p = " << p << " speed " << speed << " tolerance " << tolerance;
        }
    }
}

/// A chain of first-order lags that starts at zero: state n is the probability that n events of a Poisson process have
/// happened.
TEST(StepEvidence, ChainsThatStartAtZeroAreAccurate) {
    for (const int n : {10, 30, 60}) {
        std::string states, rates;
        for (int i = 1; i <= n; ++i) {
            states += fmt::format("x{} = 0\n", i);
            rates += i == 1 ? "x1 = \"r*(1 - x1)\"\n" : fmt::format("x{} = \"r*(x{} - x{})\"\n", i, i - 1, i);
        }
        const Model model = model_from("[parameters]\nr = 1\n[states]\n" + states + "[modes.one.rates]\n" + rates);
        for (const double tolerance : {1e-6, 1e-9, 1e-12, 1e-15})
            for (const double rate : {1e-9, 1.0, 1e9}) {
                const Simulation simulation(System(model), {}, {}, with_tolerance(tolerance));
                Trajectory trajectory(simulation, std::vector{rate});
                trajectory.start(std::vector(static_cast<std::size_t>(n), 0.0), 0, 0, n / rate);
                run(trajectory);
                ASSERT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
                long double term = std::exp(-static_cast<long double>(n)), sum = 0;
                for (int k = 0; k < n; ++k, term *= static_cast<long double>(n) / k)
                    sum += term;
                EXPECT_NEAR(trajectory.state()[static_cast<std::size_t>(n) - 1], static_cast<double>(1 - sum),
                            most_tolerances * (tolerance + 16 * epsilon))
                    << n << " lags, tolerance " << tolerance << " rate " << rate;
                // About one step for each lag, after those until states have sizes; formerly the square of their number
                // over eight.
                if (tolerance == 1e-12) {
                    EXPECT_LE(trajectory.steps(), static_cast<std::size_t>(n) + 60) << n << " rate " << rate;
                }
            }
    }
}

/// Derivatives with respect to the location of a steep place: dy/dc = f(start) - f(end) where y' = f(k (s - c)).
TEST(StepEvidence, DerivativesOfSteepMotionsAreAccurate) {
    Random random(41);
    using Value = double (*)(double);
    const std::pair<const char*, Value> functions[] = {
        {"tanh(k*(s - c))", [](double a) { return std::tanh(a); }},
        {"exp(-(k*(s - c))^2)", [](double a) { return std::exp(-a * a); }},
        {"1/(1 + (k*(s - c))^2)", [](double a) { return 1 / (1 + a * a); }},
        {"cos((k*(s - c))^5)", [](double a) { return std::cos(std::pow(a, 5)); }},
        {"erf(k*(s - c))", [](double a) { return std::erf(a); }},
    };
    for (const auto& [text, value] : functions) {
        const Model model = model_from(fmt::format(
            "parameters = {{ k = 1, c = 0 }}\nstates = {{ y = 0, s = 0 }}\nmodes.one.rates = {{ y = \"{}\", s = 1 }}\n",
            text));
        for (int i = 0; i < 200; ++i) {
            const double tolerance = random.log_uniform(1e-15, 1e-6);
            const bool chirp = text[0] == 'c';
            const double k = chirp ? random.log_uniform(0.1, 1.5) : random.log_uniform(1, 1e3);
            const double c = chirp ? -1 : random.uniform(-1, 1), end = random.uniform(0.5, 2);
            const Simulation simulation(System(model), {}, {}, with_tolerance(tolerance));
            Trajectory trajectory(simulation, std::vector{k, c});
            trajectory.start(std::vector{0.0, -1.0}, 0, 0, end);
            trajectory.carry_tangents(std::vector{0.0, 0.0, 0.0, 1.0}, 1);
            run(trajectory);
            ASSERT_EQ(trajectory.outcome().ending, Ending::end_time) << trajectory.outcome().detail;
            const double exact = value(k * (-1 - c)) - value(k * (-1 + end - c));
            // Derivatives have a hundred times the tolerance of the states. They arise as a difference of slopes that
            // are k times as large.
            EXPECT_NEAR(trajectory.tangents()[0], exact, 200 * (1 + k * end) * (tolerance + 4 * epsilon))
                << text << " k = " << k << " c = " << c << " end " << end << " tolerance " << tolerance;
        }
    }
}

} // namespace step_evidence_test
