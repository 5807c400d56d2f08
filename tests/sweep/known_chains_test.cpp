#include "graze/sweep/known_chains.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

namespace graze::known_chains_test {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

std::vector<std::pair<std::size_t, std::size_t>> missing(const KnownChains& known, std::size_t chains) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (const ItemRange& range : known.missing(chains))
        pairs.emplace_back(range.first, range.last);
    return pairs;
}

TEST(KnownChains, TakeNoMemoryForNeighbours) {
    KnownChains known;
    EXPECT_THAT(missing(known, 3), ElementsAre(Pair(0, 3)));
    EXPECT_THAT(missing(known, 0), IsEmpty());
    for (std::size_t chain = 0; chain < 4000; ++chain)
        known.end({chain, chain + 1});
    for (std::size_t chain = 6000; chain-- > 5000;)
        known.end({chain, chain + 1});
    EXPECT_THAT(known.ended(), ElementsAre(Pair(0, 4000), Pair(5000, 6000)));
    EXPECT_THAT(missing(known, 7000), ElementsAre(Pair(4000, 5000), Pair(6000, 7000)));
    EXPECT_THAT(missing(known, 4500), ElementsAre(Pair(4000, 4500)));
    EXPECT_THAT(missing(known, 3000), IsEmpty());
    known.end({3000, 5500});
    known.end({100, 100});
    EXPECT_THAT(known.ended(), ElementsAre(Pair(0, 6000)));
}

TEST(KnownChains, AChainThatEndsHasNotBegunAnyMore) {
    KnownChains known;
    known.begin(3, {2, true, {0.5}, 1});
    known.begin(5, {7, false, {}, 0});
    EXPECT_EQ(known.bound(), 6u);
    EXPECT_EQ(known.done(3, 4), 2u);
    EXPECT_EQ(known.done(5, 4), 4u);
    EXPECT_EQ(known.done(4, 4), 0u);
    EXPECT_EQ(known.begun(4), nullptr);
    known.end({2, 4});
    EXPECT_EQ(known.begun(3), nullptr);
    EXPECT_EQ(known.done(3, 4), 4u);
    known.begin(3, {1, true, {}, 0});
    EXPECT_EQ(known.done(3, 4), 4u);
    EXPECT_THAT(missing(known, 6), ElementsAre(Pair(0, 2), Pair(4, 6)));
}

TEST(KnownChains, AreTheSameAsASet) {
    // All ways to end three ranges among seven chains, and all parts of them.
    constexpr std::size_t chains = 7;
    for (std::size_t code = 0; code < 49 * 49 * 49; code += 11) {
        KnownChains known;
        std::set<std::size_t> ended;
        for (std::size_t rest = code, range = 0; range < 3; ++range, rest /= 49) {
            const std::size_t first = rest % 7, last = std::max(first, rest / 7 % 7);
            known.end({first, last});
            for (std::size_t chain = first; chain < last; ++chain)
                ended.insert(chain);
        }
        for (std::size_t chain = 0; chain < chains + 2; ++chain)
            ASSERT_EQ(known.has_ended(chain), ended.contains(chain)) << code << ' ' << chain;
        for (std::size_t first = 0; first <= chains; ++first)
            for (std::size_t last = first; last <= chains; ++last) {
                const KnownChains part = known.of({first, last});
                ASSERT_LE(part.bound(), last - first) << code;
                for (std::size_t chain = first; chain < last; ++chain)
                    ASSERT_EQ(part.has_ended(chain - first), ended.contains(chain)) << code;
            }
    }
}

} // namespace graze::known_chains_test
