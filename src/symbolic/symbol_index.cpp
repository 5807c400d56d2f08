#include "graze/symbolic/symbol_index.hpp"

#include "graze/base/input_error.hpp"

namespace graze {

SymbolIndex::SymbolIndex(std::span<const Expression> symbols) : symbols_(symbols.begin(), symbols.end()) {
    places_.reserve(symbols_.size());
    for (std::size_t place = 0; place < symbols_.size(); ++place) {
        const Expression& symbol = symbols_[place];
        if (symbol.empty() || !symbol.is_symbol())
            throw InputError("the inputs of a function must be symbols", "");
        if (!places_.emplace(symbol.index(), place).second)
            throw InputError("'" + symbol.name() + "' is an input twice", "");
        one_graph_ = one_graph_ && symbol.graph() == symbols_.front().graph();
    }
}

std::optional<std::size_t> SymbolIndex::find(NodeIndex symbol) const {
    const auto found = places_.find(symbol);
    return found == places_.end() ? std::nullopt : std::optional(found->second);
}

bool SymbolIndex::are_of(const std::shared_ptr<Graph>& graph) const {
    return symbols_.empty() || (one_graph_ && symbols_.front().graph() == graph);
}

} // namespace graze
