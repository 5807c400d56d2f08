#include "graze/symbolic/symbol_index.hpp"

#include "graze/base/input_error.hpp"

#include <gtest/gtest.h>

#include <string>

namespace graze::symbol_index_test {

TEST(SymbolIndex, FindsEachSymbolAtItsPosition) {
    const auto graph = Graph::create();
    std::vector<Expression> symbols;
    for (int i = 0; i < 100; ++i)
        symbols.push_back(graph->symbol("x" + std::to_string(i)));
    std::swap(symbols[3], symbols[70]);
    const SymbolIndex index(symbols);
    ASSERT_EQ(index.size(), symbols.size());
    for (std::size_t i = 0; i < symbols.size(); ++i)
        EXPECT_EQ(index.find(symbols[i].index()), i);
    EXPECT_FALSE(index.find(graph->symbol("y").index()));
    EXPECT_EQ(index.symbols(), symbols);
}

TEST(SymbolIndex, KnowsItsGraph) {
    const auto graph = Graph::create(), other = Graph::create();
    const Expression x = graph->symbol("x"), y = other->symbol("y"), z = other->symbol("z");
    EXPECT_TRUE(SymbolIndex(std::vector{x}).are_of(graph));
    EXPECT_FALSE(SymbolIndex(std::vector{x}).are_of(other));
    EXPECT_FALSE(SymbolIndex(std::vector{x, z}).are_of(graph)) << "symbols of two graphs";
    EXPECT_TRUE(SymbolIndex().are_of(graph));
}

TEST(SymbolIndex, RefusesRepeatedSymbolsAndOtherExpressions) {
    const auto graph = Graph::create();
    const Expression x = graph->symbol("x");
    EXPECT_THROW(SymbolIndex(std::vector{x, x}), InputError);
    EXPECT_THROW(SymbolIndex(std::vector{x + 1}), InputError);
    EXPECT_THROW(SymbolIndex(std::vector{Expression()}), InputError);
}

} // namespace graze::symbol_index_test
