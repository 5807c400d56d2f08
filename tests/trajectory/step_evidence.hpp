#pragma once

#include "closed_form.hpp"
#include "simulate.hpp"

#include <functional>

// Motions in closed form for which steps chosen from the last coefficients are wrong: coefficients vanish, or the
// motion is steep without warning. Each family draws its own cases.
namespace graze::testing {

/// One motion: its start, and the exact state at its end.
struct ClosedMotion {
    std::string label;
    std::vector<double> parameters, state;
    double end = 0;
    std::size_t judged = 0; ///< index of the compared state
    double exact = 0;       ///< its exact value at the end
    double size = 0;        ///< its largest value
    double sensitivity = 1; ///< amplification of earlier errors
};

/// A model and a generator of motions.
struct Family {
    std::string name;
    std::string model;
    std::function<ClosedMotion(Random&)> draw;
};

/// The text of a model with y' = rate(s), s' = 1.
inline std::string model_of_rate(const std::string& parameters, const std::string& rate) {
    return fmt::format(R"toml(
parameters = {{ {} }}
states = {{ y = 0, s = 0 }}
modes.m = {{ rates = {{ y = "{}", s = 1 }} }}
)toml",
                       parameters, rate);
}

/// y' = (n + 1) c s^n, s' = 1, also from y or s = 0.
inline Family power_through_zero(int n) {
    return {"power" + std::to_string(n), model_of_rate("c = 1", fmt::format("{}*c*s^{}", n + 1, n)),
            [n](Random& random) {
                ClosedMotion one;
                const double c = random.log_uniform(1e-6, 1e6), a = random.chance(0.3) ? 0 : random.uniform(-2, 1);
                const double y = random.chance(0.5) ? 0 : random.uniform(-1, 1) * c;
                one.end = random.log_uniform(0.01, 4);
                const double b = a + one.end;
                one.parameters = {c};
                one.state = {y, a};
                const auto part = [&](double s) { return c * std::pow(static_cast<long double>(s), n + 1); };
                one.exact = static_cast<double>(y + (part(b) - part(a)));
                one.size = std::max({std::abs(y), std::abs(one.exact), std::abs(double(part(a) - y))});
                one.label = fmt::format("c={} a={} y={}", c, a, y);
                return one;
            }};
}

/// y' = n q (q s)^(n-1) cos((q s)^n): y = sin((q s)^n).
inline Family chirp(int n) {
    return {"chirp" + std::to_string(n),
            model_of_rate("q = 1", fmt::format("{0}*q*(q*s)^{1}*cos((q*s)^{0})", n, n - 1)), [n](Random& random) {
                ClosedMotion one;
                const double q = random.log_uniform(1e-4, 1e4);
                const double a = random.chance(0.5) ? 0 : random.uniform(0, 1) / q;
                const double turns = random.uniform(0.1, 30), b = std::pow(turns, 1.0 / n) / q;
                one.end = std::max(b - a, 0.1 / q);
                one.parameters = {q};
                const auto value = [&](double s) { return std::sin(std::pow((long double)(q)*s, n)); };
                one.state = {static_cast<double>(value(a)), a};
                one.exact = static_cast<double>(value(a + one.end));
                one.size = 1;
                one.sensitivity = std::max(1.0, n * std::pow(q * (a + one.end), n));
                one.label = fmt::format("q={} a={}", q, a);
                return one;
            }};
}

/// y' = f(k (s - c)) with the integral F(k (s - c))/k.
inline Family steep(const std::string& name, const std::string& rate,
                    const std::function<long double(long double)>& integral, double steepest = 1e4) {
    return {name, model_of_rate("k = 1, c = 0", rate), [integral, steepest](Random& random) {
                ClosedMotion one;
                const double k = random.log_uniform(1, steepest), c = random.uniform(-1, 1);
                one.parameters = {k, c};
                one.state = {0, -1};
                one.end = random.uniform(0.5, 3);
                const long double from = k * (-1.0L - c), to = k * (-1.0L + one.end - c);
                one.exact = static_cast<double>((integral(to) - integral(from)) / k);
                one.size = one.end; // the rates are of order one
                one.label = fmt::format("k={} c={}", k, c);
                return one;
            }};
}

inline std::vector<Family> all_families() {
    std::vector<Family> families;
    for (int n = 1; n <= 60; ++n)
        families.push_back(power_through_zero(n));
    for (int n = 2; n <= 12; ++n)
        families.push_back(chirp(n));
    using Long = long double;
    families.push_back(
        steep("tanh", "tanh(k*(s - c))", [](Long a) { return std::abs(a) + std::log1p(std::exp(-2 * std::abs(a))); }));
    families.push_back(
        steep("bell", "exp(-(k*(s - c))^2)", [](Long a) { return std::erf(a) * 0.886226925452758013649L; }));
    families.push_back(steep("peak", "1/(1 + (k*(s - c))^2)", [](Long a) { return std::atan(a); }));
    families.push_back(steep("peak on one", "1 + 1/(1 + (k*(s - c))^2)", [](Long a) { return a + std::atan(a); }));
    families.push_back(
        steep("small peak", "1 + 1e-9/(1 + (k*(s - c))^2)", [](Long a) { return a + 1e-9L * std::atan(a); }));
    families.push_back(steep("step on one", "3 + tanh(k*(s - c))",
                             [](Long a) { return 3 * a + std::abs(a) + std::log1p(std::exp(-2 * std::abs(a))); }));
    families.push_back(steep(
        "logistic", "1/(1 + exp(-k*(s - c)))",
        [](Long a) { return a > 0 ? a + std::log1p(std::exp(-a)) : std::log1p(std::exp(a)); },
        300)); // beyond this, exp(-k (s - c)) overflows
    families.push_back(
        steep("switch", "atan(k*(s - c))", [](Long a) { return a * std::atan(a) - std::log1p(a * a) / 2; }));
    families.push_back(steep("error function", "erf(k*(s - c))", [](Long a) {
        return a * std::erf(a) + std::exp(-a * a) * 0.564189583547756286948L; // 1/sqrt(pi)
    }));
    return families;
}

} // namespace graze::testing
