#include "graze/picture/trip_series.hpp"

#include "base/special_numbers.hpp"

#include <limits>

namespace graze {

void add_trips(FigurePanel& panel, const std::vector<std::pair<double, TripTime>>& trips, const std::string& title,
               std::size_t colour, int symbol, bool at_fold) {
    FigureSeries line{"", FigureSeries::Style::line, colour, {}};
    FigureSeries marks{title, FigureSeries::Style::symbols, colour, {}};
    marks.symbol = symbol;
    const TripTime* before = nullptr;
    for (const auto& [overshoot, trip] : trips) {
        if (!at_fold && before && before->contacts != trip.contacts)
            line.points.push_back({not_a_number, not_a_number});
        line.points.push_back({overshoot, trip.time});
        marks.points.push_back({overshoot, trip.time});
        before = &trip;
    }
    if (marks.points.empty())
        return;
    panel.series.push_back(std::move(line));
    panel.series.push_back(std::move(marks));
}

} // namespace graze
