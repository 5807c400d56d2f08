#include "derivative_peers.hpp"

#include "../chain.hpp"
#include "hybrid_case.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace peers {

namespace {

constexpr std::array methods = {CvodesMethod{false, false}, CvodesMethod{false, true}, CvodesMethod{true, false},
                                CvodesMethod{true, true}};
/// Errors at which times are compared.
constexpr std::array levels = {1e-6, 1e-9};

/// Returns tolerances by decades; every second one where runs take long.
std::vector<double> tolerances(const HybridCase& one, int from, int to) {
    constexpr std::size_t many_states = 100;
    std::vector<double> result;
    for (int power = from; power <= to; power += one.scales.size() < many_states ? 1 : 2)
        result.push_back(std::pow(10.0, -power));
    return result;
}

/// The fastest CVODES method at the first level; only this one is run at all tolerances.
struct Fastest {
    CvodesMethod method;
    std::vector<Effort> efforts;
    Outcome last; ///< at the smallest tolerance
};

std::vector<Effort> line_of(const std::vector<double>& all, const std::function<Effort(double, Outcome&)>& effort,
                            Outcome& last) {
    std::vector<Effort> result;
    for (const double tolerance : all)
        result.push_back(effort(tolerance, last));
    return result;
}

Fastest fastest_of(const HybridCase& one, const Outcome& reference, double budget) {
    std::optional<std::pair<double, CvodesMethod>> best;
    for (const CvodesMethod method : methods) {
        Outcome outcome;
        const std::vector<Effort> tried = line_of(
            {1e-6, 1e-7, 1e-8},
            [&](double tolerance, Outcome& last) {
                return cvodes_effort(one, method, tolerance, 0.1 * budget, reference, last);
            },
            outcome);
        const std::optional<double> seconds = seconds_at(tried, levels.front());
        if (seconds && (!best || *seconds < best->first))
            best = {*seconds, method};
    }
    Fastest result{best ? best->second : methods.front(), {}, {}};
    result.efforts = line_of(
        tolerances(one, 5, 13),
        [&](double tolerance, Outcome& last) {
            return cvodes_effort(one, result.method, tolerance, budget, reference, last);
        },
        result.last);
    return result;
}

void print_milliseconds(const std::optional<double>& seconds, int periods) {
    if (seconds)
        std::printf(" %.4g |", 1e3 * *seconds / periods);
    else
        std::printf(" - |");
}

void print_row(const HybridCase& one, double budget) {
    const Outcome reference = reference_of(one);
    Outcome own;
    const std::vector<Effort> efforts = line_of(
        tolerances(one, 4, 14),
        [&](double tolerance, Outcome& last) { return graze_effort(one, tolerance, budget, reference, last); }, own);
    const Fastest peer = fastest_of(one, reference, budget);
    std::printf("| %s | %zu |", one.name.c_str(), one.scales.size() + 1);
    for (const double level : levels) {
        const auto seconds = seconds_at(efforts, level), other = seconds_at(peer.efforts, level);
        print_milliseconds(seconds, one.periods);
        print_milliseconds(other, one.periods);
        if (seconds && other)
            std::printf(" %.3g |", *other / *seconds);
        else
            std::printf(" - |");
    }
    const auto least = [](const std::vector<Effort>& all) {
        double error = INFINITY;
        for (const Effort& effort : all)
            error = std::fmin(error, effort.error);
        return error;
    };
    std::printf(" %.1e | %.1e | %s | %zu, %zu, %zu | %.1e | %.1e |\n", least(efforts), least(peer.efforts),
                peer.method.name().c_str(), reference.meetings.size(), own.meetings.size(), peer.last.meetings.size(),
                distance_of_meetings(own, reference) / one.duration,
                distance_of_meetings(own, peer.last) / one.duration);
    std::fflush(stdout);
}

void print_head(const char* title) {
    std::printf(
        "\n%s\n\n"
        "| motion | inputs | at 1e-6: graze | CVODES | ratio | at 1e-9: graze | CVODES | ratio | least error: "
        "graze | CVODES | method | contacts: reference, graze, CVODES | apart: graze, reference | graze, CVODES "
        "|\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
        title);
}

} // namespace

void compare_derivatives(bool quick) {
    const double budget = quick ? 0.02 : 0.2;
    const std::vector<std::size_t> sizes =
        quick ? std::vector<std::size_t>{1, 5} : std::vector<std::size_t>{1, 5, 10, 20, 50, 100};
    print_head("Derivatives by all states and a parameter: ms a period at equal error, against CVODES");
    for (const std::size_t size : sizes)
        if (size <= 20)
            print_row(chain_case(size, Chain::large_force, size <= 5 ? 3 : 1), budget);
    print_row(testbed_case(3), budget);
    print_row(beam_case(1, 3), budget);
    if (!quick)
        print_row(beam_case(9, 1), budget);
    for (const std::size_t size : sizes)
        print_row(chain_case(size, Chain::small_force, 1), budget);
}

} // namespace peers
