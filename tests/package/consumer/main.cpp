// Parses an expression and loads a model with nothing but the installed package.
#include "graze/model/catalogue.hpp"
#include "graze/symbolic/function.hpp"
#include "graze/symbolic/parser.hpp"

#include <iostream>
#include <vector>

int main() {
    const auto graph = graze::Graph::create();
    const graze::Expression x = graph->symbol("x");
    const graze::Expression square = graze::parse_expression(*graph, "x^2", {{"x", x}});
    const graze::Function evaluate(std::vector{x}, std::vector{square});
    if (evaluate(std::vector{3.0}).at(0) != 9) {
        std::cerr << "3^2 is not 9\n";
        return 1;
    }
    if (graze::catalogue().empty()) {
        std::cerr << "no models were shipped\n";
        return 1;
    }
    const graze::Model model = graze::load_model(graze::catalogue().front().name);
    model.validate();
    std::cout << model.name << " has " << model.states.size() << " states\n";
    return 0;
}
