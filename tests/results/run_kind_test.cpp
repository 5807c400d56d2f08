#include "graze/results/run_kind.hpp"

#include <gtest/gtest.h>

namespace graze::run_kind_test {

TEST(RunKind, NamesMapBackToKinds) {
    for (std::size_t kind = 0; kind < kinds_of_runs().size(); ++kind) {
        const auto one = static_cast<RunKind>(kind);
        EXPECT_EQ(name_of(one), kinds_of_runs()[kind]);
        EXPECT_EQ(run_kind(name_of(one)), one);
        EXPECT_EQ(has_motions(one) + is_branch(one) + is_measured(one), 1) << name_of(one);
    }
    EXPECT_EQ(name_of(RunKind::atlas), "atlas"); // the last kind
    EXPECT_EQ(run_kind("continue"), RunKind::follow);
    EXPECT_EQ(run_kind("follow"), std::nullopt);
    EXPECT_EQ(name_of(static_cast<RunKind>(99)), "unknown");
}

TEST(RunKind, SweepsAndAtlasesAreSwept) {
    for (const std::string& name : kinds_of_runs())
        EXPECT_EQ(is_swept(*run_kind(name)), name == "sweep" || name == "atlas") << name;
    EXPECT_TRUE(seeks_attractors(RunKind::atlas));
}

TEST(RunKind, AnOrbitIsNotFollowed) {
    EXPECT_TRUE(is_branch(RunKind::orbit));
    EXPECT_FALSE(is_followed(RunKind::orbit));
    EXPECT_TRUE(is_followed(RunKind::ladder));
}

} // namespace graze::run_kind_test
