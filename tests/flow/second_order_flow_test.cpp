#include "graze/flow/second_order_flow.hpp"

#include "graze/model/model_file.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"
#include "model/shipped_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <thread>

namespace graze::second_order_flow_test {

using Numbers = std::vector<double>;

constexpr double tolerance = 1e-15;

struct Flown {
    Numbers state, first, second;
    std::size_t steps;
};

/// Runs the flow from a start, which is unchanged.
Flown fly(SecondOrderFlow& flow, std::size_t mode, const Numbers& start, double duration, const Numbers& vector) {
    const std::size_t entries = start.size() * flow.system().variables();
    Flown flown{start, Numbers(entries), Numbers(entries), flow.steps()};
    EXPECT_EQ(flow.run(mode, flown.state, duration, vector, flown.first, flown.second), ModeFlow::Ending::done);
    flown.steps = flow.steps() - flown.steps;
    return flown;
}

std::vector<ParameterId> all_parameters(const Model& model) {
    std::vector<ParameterId> all;
    for (std::size_t j = 0; j < model.parameter_values().size(); ++j)
        all.push_back(ParameterId(j));
    return all;
}

Numbers random_numbers(std::size_t count, std::mt19937_64& random) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Numbers numbers(count);
    for (double& number : numbers)
        number = uniform(random);
    return numbers;
}

/// Contraction of a matrix, row by row, with a vector.
Numbers product(const Numbers& matrix, const Numbers& vector) {
    Numbers result(matrix.size() / vector.size());
    for (std::size_t i = 0; i < result.size(); ++i)
        for (std::size_t j = 0; j < vector.size(); ++j)
            result[i] += matrix[i * vector.size() + j] * vector[j];
    return result;
}

/// A model with one mode, whose flow is known in closed form.
struct Solved {
    std::string text; ///< as in a model file, up to the rates
    std::string rates;
    std::vector<std::string> flow; ///< each state after the time t, in terms of states and parameters
    Numbers start;
    Numbers times;
    double accuracy = 1e-13;
};

std::vector<Solved> solved() {
    return {
        // Riccati's equation without and with a source.
        {"[parameters]\nk = 0.8\n[states]\nx = 1\n", "x = \"-k*x^2\"", {"x/(1 + k*x*t)"}, {1.3}, {0.4, 3.0, -0.5}},
        {"[parameters]\nk = 0.8\np = 0.5\n[states]\nx = 1\n",
         "x = \"-k*x^2 + p\"",
         {"sqrt(p/k)*(x + sqrt(p/k)*tanh(sqrt(p*k)*t))/(sqrt(p/k) + x*tanh(sqrt(p*k)*t))"},
         {1.3},
         {0.4, 2.0, -0.4}},
        // Logistic growth.
        {"[parameters]\nr = 1.7\nK = 3\n[states]\nx = 1\n",
         "x = \"r*x*(1 - x/K)\"",
         {"K*x/(x + (K - x)*exp(-r*t))"},
         {0.2},
         {0.3, 2.5, -1.1}},
        // Linear in the states: only derivatives by parameters are nonzero. One parameter is dependent.
        {"[parameters]\nm = 2\ns = 5\nk = \"s/m\"\n[states]\nx = 1\nv = 0\n[definitions]\nforce = \"-k*x\"\n",
         "x = \"v\", v = \"force\"",
         {"x*cos(sqrt(s/m)*t) + v/sqrt(s/m)*sin(sqrt(s/m)*t)", "v*cos(sqrt(s/m)*t) - x*sqrt(s/m)*sin(sqrt(s/m)*t)"},
         {0.8, -0.3},
         {0.7, 6.0, -2.2}},
        // Forced, with a cyclic phase that exceeds its period, and a start at rest.
        {"[parameters]\na = 1.5\nomega = 2\n[states]\nx = 0\ntheta = { initial = 0, period = \"2*pi\" }\n",
         "x = \"a*cos(theta)\", theta = \"omega\"",
         {"x + a*(sin(theta + omega*t) - sin(theta))/omega", "theta + omega*t"},
         {0.0, 0.0},
         {0.6, 9.0, -4.0}},
        // Roots and powers.
        {"[states]\nx = 1\n", "x = \"-sqrt(x)\"", {"(sqrt(x) - t/2)^2"}, {2.0}, {1.0, -3.0}},
        {"[parameters]\nn = 1.7\n[states]\nx = 1\n",
         "x = \"-x^n\"",
         {"(x^(1 - n) + (n - 1)*t)^(1/(1 - n))"},
         {0.9},
         {0.5, 4.0, -0.6}},
        // A growing perturbation: derivatives far larger than the state.
        {"[parameters]\nb = 4\n[states]\nx = 0\ny = 1\n",
         "x = \"b*x\", y = \"x*y\"",
         {"x*exp(b*t)", "y*exp(x*(exp(b*t) - 1)/b)"},
         {1e-9, 1.0},
         {4.0, -1.0}},
    };
}

TEST(SecondOrderFlow, AgreesWithClosedFormsForwardsAndBackwards) {
    for (const Solved& problem : solved()) {
        const Model model = parse_model("name = \"solved\"\n" + problem.text + "[modes.m]\nrates = { " + problem.rates +
                                            " }\n[initial]\nmode = \"m\"\n",
                                        "solved.toml");
        const std::size_t n = model.states.size(), variables = n + model.parameter_values().size();
        SCOPED_TRACE(problem.rates);
        // The closed form, differentiated twice.
        Graph& graph = *model.graph;
        std::vector<Expression> inputs = model.inputs();
        Scope scope;
        for (const Expression& input : inputs)
            scope.emplace(input.name(), input);
        scope.emplace("t", graph.symbol("t"));
        std::vector<Expression> values;
        for (const std::string& text : problem.flow)
            values.push_back(parse_expression(graph, text, scope));
        const std::vector<Expression> first = jacobian(values, inputs), second = jacobian(first, inputs);
        inputs.push_back(graph.symbol("t"));
        const Function value_of(inputs, values), first_of(inputs, first), second_of(inputs, second);

        SecondOrderFlow flow(VariationalSystem(System(model), all_parameters(model)), tolerance);
        flow.set_parameters(model.parameter_values());
        std::mt19937_64 random(7);
        for (const double time : problem.times) {
            Numbers at = problem.start;
            for (const double parameter : model.parameter_values())
                at.push_back(parameter);
            at.push_back(time);
            const Numbers vector = random_numbers(variables, random);
            const Flown flown = fly(flow, 0, problem.start, time, vector);
            const Numbers exact = value_of(at), exact_first = first_of(at), exact_second = second_of(at);
            for (std::size_t i = 0; i < n; ++i) {
                EXPECT_NEAR(flown.state[i], exact[i], problem.accuracy * (1 + std::abs(exact[i])));
                for (std::size_t j = 0; j < variables; ++j) {
                    const std::size_t entry = i * variables + j;
                    EXPECT_NEAR(flown.first[entry], exact_first[entry],
                                problem.accuracy * (1 + std::abs(exact_first[entry])));
                    double contracted = 0, size = 0;
                    for (std::size_t k = 0; k < variables; ++k) {
                        contracted += exact_second[entry * variables + k] * vector[k];
                        size += std::abs(exact_second[entry * variables + k] * vector[k]);
                    }
                    EXPECT_NEAR(flown.second[entry], contracted, 10 * problem.accuracy * (1 + size))
                        << i << ' ' << j << " after " << time;
                }
            }
        }
    }
}

Model pendulum() {
    return parse_model(R"(
name = "pendulum"
parameters = { damping = 0.1, force = 1.2, omega = 0.7 }
states = { x = 1, v = 0, theta = { initial = 0, period = "2*pi" } }
modes.swing = { rates = { x = "v", v = "force*cos(theta) - sin(x) - damping*v", theta = "omega" } }
modes.fall = { rates = { x = "v", v = "force - damping*v^2", theta = "omega" } }
initial.mode = "swing"
)",
                       "pendulum.toml");
}

/// Returns central differences of derivatives, (D(y + h u) v - D(y - h u) v) / 2h.
Numbers difference(ModeFlow& flow, std::size_t mode, const Numbers& start, const Numbers& parameters, double duration,
                   const Numbers& vector, const Numbers& along, double h) {
    const std::size_t n = start.size();
    std::vector<Numbers> tangents;
    for (const double sign : {1.0, -1.0}) {
        Numbers state = start, changed = parameters, derivatives(n * vector.size());
        for (std::size_t i = 0; i < n; ++i)
            state[i] += sign * h * along[i];
        for (std::size_t f = 0; f < flow.free().size(); ++f)
            changed[flow.free()[f].place()] += sign * h * along[n + f];
        flow.set_parameters(changed);
        EXPECT_EQ(flow.run(mode, state, duration, derivatives), ModeFlow::Ending::done);
        tangents.push_back(product(derivatives, vector));
    }
    for (std::size_t i = 0; i < n; ++i)
        tangents[0][i] = (tangents[0][i] - tangents[1][i]) / (2 * h);
    return tangents[0];
}

TEST(SecondOrderFlow, AgreesWithTheLimitOfDifferences) {
    const System system(pendulum());
    const std::vector free{ParameterId(0), ParameterId(1), ParameterId(2)};
    const Numbers parameters = system.model().parameter_values(), start{1.0, -0.4, 0.3};
    SecondOrderFlow flow(VariationalSystem(system, free), tolerance);
    ModeFlow first(system, tolerance, 0, free);
    flow.set_parameters(parameters);
    std::mt19937_64 random(11);
    for (const double duration : {1.0, 7.0, -2.0}) {
        const Numbers vector = random_numbers(6, random), along = random_numbers(6, random);
        const Numbers exact = product(fly(flow, 0, start, duration, vector).second, along);
        // Richardson extrapolation (Romberg's scheme).
        std::vector<Numbers> rows;
        double last = std::numeric_limits<double>::infinity();
        double h = 0.02;
        for (int level = 0; level < 4; ++level, h /= 2) {
            rows.push_back(difference(first, 0, start, parameters, duration, vector, along, h));
            double error = 0;
            for (std::size_t i = 0; i < 2; ++i)
                error = std::max(error, std::abs(rows.back()[i] - exact[i]));
            if (level > 0) {
                EXPECT_NEAR(error / last, 0.25, 0.02) << duration << ' ' << level;
            }
            last = error;
        }
        for (std::size_t column = 1; column < rows.size(); ++column)
            for (std::size_t row = rows.size(); row-- > column;)
                for (std::size_t i = 0; i < 3; ++i)
                    rows[row][i] += (rows[row][i] - rows[row - 1][i]) / (std::pow(4.0, column) - 1);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(rows.back()[i], exact[i], 1e-10 * (1 + std::abs(exact[i]))) << duration << ' ' << i;
    }
}

/// Second derivatives over two parts of an arc combine to those over the whole by the chain rule.
TEST(SecondOrderFlow, ComposesByTheChainRule) {
    const VariationalSystem system(System(pendulum()), {ParameterId(2), ParameterId(0)});
    const std::size_t n = 3, variables = system.variables();
    SecondOrderFlow flow(system, tolerance);
    flow.set_parameters(system.system().model().parameter_values());
    const Numbers start{1.0, -0.4, 0.3};
    std::mt19937_64 random(3);
    for (const auto& [one, other] : {std::pair(1.3, 2.1), std::pair(2.0, -0.7), std::pair(3.0, -3.0)})
        for (std::size_t mode = 0; mode < 2; ++mode) {
            const Numbers vector = random_numbers(variables, random);
            const Flown whole = fly(flow, mode, start, one + other, vector),
                        before = fly(flow, mode, start, one, vector);
            Numbers moved = product(before.first, vector);
            moved.insert(moved.end(), vector.begin() + n, vector.end());
            const Flown after = fly(flow, mode, before.state, other, moved);
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < variables; ++j) {
                    double first = j < n ? 0 : after.first[i * variables + j],
                           second = j < n ? 0 : after.second[i * variables + j];
                    for (std::size_t k = 0; k < n; ++k) {
                        first += after.first[i * variables + k] * before.first[k * variables + j];
                        second += after.second[i * variables + k] * before.first[k * variables + j] +
                                  after.first[i * variables + k] * before.second[k * variables + j];
                    }
                    EXPECT_NEAR(first, whole.first[i * variables + j], 1e-12);
                    EXPECT_NEAR(second, whole.second[i * variables + j], 1e-11) << i << ' ' << j << ' ' << other;
                    if (one + other == 0) {
                        EXPECT_EQ(whole.first[i * variables + j], i == j ? 1 : 0);
                        EXPECT_EQ(whole.second[i * variables + j], 0);
                    }
                }
        }
}

/// States that are zero or small at the start do not make steps small.
TEST(SecondOrderFlow, TakesFewStepsWhereDerivativesStartAtZero) {
    const Model model = parse_model("name = \"chain\"\n[parameters]\np = 0\n[states]\na = 0\nb = 0\nc = 0\nd = 0\n"
                                    "e = 0\nf = 0\n[modes.m]\nrates = { a = \"b\", b = \"c\", c = \"d\", d = \"e\", "
                                    "e = \"f\", f = \"sin(a) + p*a^2 + p\" }\n[initial]\nmode = \"m\"\n",
                                    "chain.toml");
    const System system(model);
    for (const Numbers& vector : {Numbers{0, 0, 0, 0, 0, 1, 0}, Numbers{0, 0, 0, 0, 0, 0, 1},
                                  Numbers{1e-18, 1, 0, 1e-30, 0, 0, 1}, Numbers(7, 0.0)})
        for (const double p : {0.0, 0.3}) {
            const Numbers start{p, 0, 0, 0, 0, 0}, parameters{p};
            ModeFlow first(system, tolerance, 0, {ParameterId(0)});
            first.set_parameters(parameters);
            Numbers state = start, derivatives(6 * 7);
            ASSERT_EQ(first.run(0, state, 3.0, derivatives), ModeFlow::Ending::done);
            SecondOrderFlow flow(VariationalSystem(system, {ParameterId(0)}), tolerance);
            flow.set_parameters(parameters);
            const Flown flown = fly(flow, 0, start, 3.0, vector);
            EXPECT_LE(flow.steps(), 30 + 2 * first.steps());
            for (std::size_t i = 0; i < derivatives.size(); ++i)
                EXPECT_NEAR(flown.first[i], derivatives[i], 1e-13 * (1 + std::abs(derivatives[i])));
        }
}

/// A point at which a mode is tested, the scales of its states, and a time over which the flow exists.
struct Setting {
    Numbers start, scales;
    double duration;
};
Setting setting_of(const System& system, std::size_t mode) {
    constexpr int parts = 8;
    const Model& model = system.model();
    const Numbers parameters = model.parameter_values();
    ModeFlow flow(system, tolerance);
    flow.set_parameters(parameters);
    // A radian or two of the forcing phase, whose frequency is given directly or by the period.
    const auto share_of_period = [&](const char* frequency, double share) {
        return share / model.values_of(std::vector{model.symbol(frequency)}).front();
    };
    double duration = model.find_parameter("omega") ? share_of_period("omega", 2)
                      : model.find_parameter("f")   ? share_of_period("f", 0.3)
                                                    : 1;
    for (;; duration /= 2) {
        Setting setting{{}, Numbers(model.states.size(), 0.0), duration};
        Numbers state = model.initial_state();
        bool done = true;
        for (const std::size_t followed : {model.initial_mode, mode}) {
            setting.start = state;
            for (int part = 0; part < parts && done; ++part) {
                done = flow.run(followed, state, duration / parts) == ModeFlow::Ending::done;
                for (std::size_t i = 0; i < state.size(); ++i)
                    setting.scales[i] = std::max(setting.scales[i], std::abs(state[i]));
            }
        }
        if (done)
            return setting;
    }
}

/// A mode of a model with derivatives by all parameters, and two vectors of typical size.
class Shipped {
public:
    Shipped(const VariationalSystem& system, std::size_t mode, std::mt19937_64& random)
        : system_(system), n_(system.system().states()), variables_(system.variables()), mode_(mode),
          setting_(setting_of(system.system(), mode)), parameters_(system.system().model().parameter_values()),
          v_(natural_vector(random)), u_(natural_vector(random)), vu_(contracted(v_, u_, tolerance)), sizes_(n_) {
        for (std::size_t k = 0; k < variables_; ++k) {
            Numbers unit(variables_, 0.0);
            unit[k] = 1;
            const Numbers by_k = fly(unit, tolerance).second;
            for (std::size_t i = 0; i < n_; ++i)
                for (std::size_t j = 0; j < variables_; ++j)
                    sizes_[i] += std::abs(by_k[i * variables_ + j] * v_[k] * u_[j]);
        }
    }

    void expect_symmetry() const {
        const Numbers uv = contracted(u_, v_, tolerance);
        for (std::size_t i = 0; i < n_; ++i)
            EXPECT_NEAR(vu_[i], uv[i], 1e-14 * sizes_[i]) << i;
    }

    void expect_tolerances_to_hold() const {
        for (const double rough : {1e-4, 1e-6, 1e-9, 1e-12}) {
            const Numbers roughly = contracted(v_, u_, rough);
            for (std::size_t i = 0; i < n_; ++i)
                EXPECT_NEAR(roughly[i], vu_[i], 10 * rough * sizes_[i]) << i << " with " << rough;
        }
    }

    /// Halving the difference reduces the error to a quarter.
    void expect_limit_of_differences() const {
        ModeFlow first(system_.system(), tolerance, 0, system_.free());
        std::vector<Numbers> differences;
        for (const double h : {0.004, 0.002})
            differences.push_back(difference(first, mode_, setting_.start, parameters_, setting_.duration, v_, u_, h));
        for (std::size_t i = 0; i < n_; ++i) {
            const double scale = std::max(sizes_[i], setting_.scales[i]), coarse = std::abs(differences[0][i] - vu_[i]),
                         fine = std::abs(differences[1][i] - vu_[i]);
            EXPECT_LE(coarse, 5e-3 * scale) << i;
            EXPECT_NEAR(fine, coarse / 4, 0.01 * coarse + 1e-10 * scale) << i;
        }
    }

    void expect_few_steps() const {
        ModeFlow first(system_.system(), tolerance, 0, system_.free());
        first.set_parameters(parameters_);
        Numbers state = setting_.start, derivatives(n_ * variables_);
        ASSERT_EQ(first.run(mode_, state, setting_.duration, derivatives), ModeFlow::Ending::done);
        EXPECT_LE(fly(v_, tolerance).steps, 3 + 3 * first.steps() / 2);
    }

private:
    Flown fly(const Numbers& vector, double within) const {
        SecondOrderFlow flow(system_, within);
        flow.set_parameters(parameters_);
        return second_order_flow_test::fly(flow, mode_, setting_.start, setting_.duration, vector);
    }
    Numbers contracted(const Numbers& one, const Numbers& other, double within) const {
        return product(fly(one, within).second, other);
    }
    Numbers natural_vector(std::mt19937_64& random) const {
        Numbers vector = random_numbers(variables_, random);
        for (std::size_t j = 0; j < variables_; ++j)
            vector[j] *= j < n_ ? setting_.scales[j] : 0.05 * parameters_[j - n_];
        return vector;
    }

    VariationalSystem system_;
    std::size_t n_, variables_, mode_;
    Setting setting_;
    Numbers parameters_, v_, u_;
    Numbers vu_;    ///< second derivatives contracted with both vectors
    Numbers sizes_; ///< sizes of their terms, which may cancel
};

/// Properties that need no known solution, for every mode of every shipped model and all its parameters.
TEST(SecondOrderFlow, IsSymmetricAndTheLimitOfDifferencesOnEveryShippedModel) {
    std::size_t modes = 0;
    std::set<std::filesystem::path> files;
    for (const auto& file : std::filesystem::directory_iterator(testing::models_folder()))
        if (file.path().extension() == ".toml")
            files.insert(file.path());
    for (const auto& file : files) {
        const System system(read_model(file.string()));
        std::mt19937_64 random(5); // the same vectors for each model
        const VariationalSystem variational(system, all_parameters(system.model()));
        for (std::size_t mode = 0; mode < system.model().modes.size(); ++mode, ++modes) {
            SCOPED_TRACE(system.model().name + " " + system.model().modes[mode].name);
            const Shipped shipped(variational, mode, random);
            shipped.expect_symmetry();
            shipped.expect_tolerances_to_hold();
            shipped.expect_limit_of_differences();
            shipped.expect_few_steps();
        }
    }
    EXPECT_GE(modes, 25u);
}

TEST(SecondOrderFlow, GivesTheSameOnFourThreadsThatShareASystem) {
    const VariationalSystem system(System(pendulum()), {ParameterId(0), ParameterId(1), ParameterId(2)});
    const auto once = [&system] {
        SecondOrderFlow flow(system, tolerance);
        flow.set_parameters(system.system().model().parameter_values());
        return fly(flow, 0, {1.0, -0.4, 0.3}, 5.0, {1, 2, 3, -1, -2, -3}).second;
    };
    const Numbers expected = once();
    std::vector<Numbers> results(4);
    std::vector<std::thread> threads;
    for (Numbers& result : results)
        threads.emplace_back([&result, &once] { result = once(); });
    for (std::thread& thread : threads)
        thread.join();
    for (const Numbers& result : results)
        EXPECT_EQ(result, expected);
}

TEST(SecondOrderFlow, ReportsHowItEnds) {
    const Model model = parse_model("name = \"a\"\n[states]\nx = 1\n[modes.m]\nrates = { x = \"x^2\" }\n"
                                    "[initial]\nmode = \"m\"\n",
                                    "a.toml");
    SecondOrderFlow flow(VariationalSystem(System(model)), tolerance);
    const auto ending_of = [&](double start, double duration, double component) {
        Numbers state{start}, first(1), second(1);
        return flow.run(0, state, duration, Numbers{component}, first, second);
    };
    EXPECT_EQ(ending_of(1, 0.5, 1), ModeFlow::Ending::done);
    EXPECT_EQ(ending_of(1, 2.0, 1), ModeFlow::Ending::singular); // 1/(1 - t)
    EXPECT_EQ(ending_of(1, std::numeric_limits<double>::infinity(), 1), ModeFlow::Ending::undefined);
    EXPECT_EQ(ending_of(std::numeric_limits<double>::quiet_NaN(), 0.5, 1), ModeFlow::Ending::undefined);
    EXPECT_EQ(ending_of(1, 0.5, 1e308), ModeFlow::Ending::undefined);
}

} // namespace graze::second_order_flow_test
