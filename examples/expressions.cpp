// Builds, parses, differentiates and evaluates expressions.

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"
#include "graze/symbolic/transform.hpp"

#include <cmath>
#include <iostream>
#include <vector>

int main() {
    using namespace graze;
    const auto graph = Graph::create();
    const Expression x = graph->symbol("x"); // position of an electrode
    const Expression V = graph->symbol("V"); // voltage

    // By operators, or from text: equal expressions are the same node.
    const Expression force = pow(V, 2) / pow(1 - x, 2);
    const Scope scope{{"x", x}, {"V", V}};
    const bool same = parse_expression(*graph, "V^2/(1 - x)^2", scope) == force;
    std::cout << "force            " << to_string(force) << (same ? " (both ways)" : "") << '\n';

    // Exact derivatives, and values.
    const Expression stiffness = differentiate(force, x);
    std::cout << "d force/dx       " << to_string(stiffness) << '\n';
    const Function function(std::vector{x, V}, std::vector{force, stiffness});
    const std::vector<double> values = function(std::vector{0.5, 2.0});
    std::cout << "at x=0.5, V=2    " << values[0] << ' ' << values[1] << '\n';

    // Substitution.
    const Expression omega = graph->symbol("omega");
    const Expression phase = graph->symbol("phase");
    const std::vector<Replacement> driven{{V, omega * sin(phase)}};
    std::cout << "driven           " << to_string(substitute(force, driven)) << '\n';

    // A mistake is reported with its place and a remedy.
    try {
        parse_expression(*graph, "V^2/(1 - z)", scope, {"model.toml", 12, 10});
    } catch (const InputError& error) {
        std::cout << error.what() << '\n';
    }
    return same && std::abs(values[0] - 16) < 1e-12 && std::abs(values[1] - 64) < 1e-12 ? 0 : 1;
}
