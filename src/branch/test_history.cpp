#include "branch/test_history.hpp"

#include "base/special_numbers.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace graze {

void TestHistory::add(double arclength, const std::vector<BranchTest>& tests) {
    if (!points_.empty() && points_.front().values.size() != tests.size())
        forget();
    std::vector<double> values;
    std::ranges::transform(tests, std::back_inserter(values), &BranchTest::value);
    points_.insert(points_.begin(), {arclength, std::move(values)});
    if (points_.size() > most)
        points_.pop_back();
}

std::optional<Dip> TestHistory::find_dip(std::size_t test, double begin, double length, const TestValue& low,
                                         const TestValue& high, double noise,
                                         const std::function<double(double)>& value_at) const {
    const auto value = [&](std::size_t place) {
        if (place >= points_.size() || test >= points_[place].values.size())
            return TestValue{not_a_number, not_a_number};
        return TestValue{(points_[place].arclength - begin) / length, points_[place].values[test]};
    };
    const auto place = possible_dip(value(1), value(0), low, high);
    return place ? dip_between(low, high, *place, noise, value_at) : std::nullopt;
}

} // namespace graze
