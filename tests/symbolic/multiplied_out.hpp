#pragma once

#include "graze/symbolic/function.hpp"
#include "graze/symbolic/linearisation.hpp"
#include "graze/symbolic/transform.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace graze::testing {

/// Numerical derivatives of functions with respect to variables, row by row.
struct DenseDerivatives {
    std::vector<double> values;
    std::vector<double> sizes; ///< for each row, the largest of the products that were summed
};

/// Eliminates the intermediates numerically, at given values of the variables.
inline DenseDerivatives multiplied_out(const Linearisation& linear, const SymbolIndex& variables,
                                       std::span<const double> at) {
    std::vector<Expression> coefficients;
    for (const LinearEntry& entry : linear.entries)
        coefficients.push_back(entry.coefficient);
    const std::vector<double> values = Function(variables, coefficients)(at);
    const std::size_t n = linear.variables, rows = linear.intermediates + linear.functions;
    std::vector<double> all(rows * n), sizes(rows * n);
    for (std::size_t i = 0; i < values.size(); ++i) {
        const LinearEntry& entry = linear.entries[i];
        double* row = all.data() + entry.row * n;
        double* size = sizes.data() + entry.row * n;
        if (entry.source < n) {
            row[entry.source] += values[i];
            size[entry.source] += std::abs(values[i]);
            continue;
        }
        for (std::size_t column = 0; column < n; ++column) {
            const std::size_t from = (entry.source - n) * n + column;
            // A zero derivative stays zero, however large the coefficient is.
            if (sizes[from] != 0) {
                row[column] += values[i] * all[from];
                size[column] += std::abs(values[i]) * sizes[from];
            }
        }
    }
    DenseDerivatives result;
    result.values.assign(all.begin() + static_cast<std::ptrdiff_t>(linear.intermediates * n), all.end());
    for (std::size_t row = linear.intermediates; row < rows; ++row) {
        double size = 0;
        for (std::size_t column = 0; column < n; ++column)
            size = std::fmax(size, sizes[row * n + column]);
        result.sizes.push_back(size);
    }
    return result;
}

/// The same derivatives by the sparse Jacobian.
inline std::vector<double> plain_derivatives(std::span<const Expression> functions, const SymbolIndex& variables,
                                             std::span<const double> at) {
    std::vector<Function::Output> outputs;
    for (JacobianEntry& entry : sparse_jacobian(functions, variables))
        outputs.push_back({entry.row * variables.size() + entry.column, std::move(entry.value)});
    const Function function(variables, functions.size() * variables.size(), outputs, Function::Others::zero);
    return function(at);
}

/// Returns the sparse Jacobian as a linearisation.
inline Linearisation plain_linearisation(std::span<const Expression> functions, const SymbolIndex& variables,
                                         std::size_t states) {
    Linearisation plain{variables.size(), functions.size(), 0, {}};
    const std::span<const Expression> moving(variables.symbols().data(), states);
    for (JacobianEntry& entry : sparse_jacobian(functions, variables)) {
        bool varies = false;
        for (const Expression& symbol : symbols_of({&entry.value, 1}))
            varies = varies || variables.find(symbol.index()).value_or(states) < moving.size();
        plain.entries.push_back({entry.row, entry.column, std::move(entry.value), varies});
    }
    return plain;
}

} // namespace graze::testing
