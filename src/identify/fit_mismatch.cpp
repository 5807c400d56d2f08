#include "identify/fit_findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Readings and residuals of one channel of one record.
struct Compared {
    std::vector<double> times, read, left;
};

Compared compared(const FitRows& rows, const std::vector<PieceRows>& known, std::size_t record, std::size_t channel) {
    const FitRecord& all = rows.task().records[record];
    const std::size_t channels = all.readings.size();
    Compared result;
    for (std::size_t k = 0; k < known.size(); ++k) {
        const FitPiece& piece = rows.layout.pieces[k];
        if (piece.record != record || !known[k].finite)
            continue;
        for (std::size_t i = 0; i < known[k].residuals.size() / channels && piece.first + i < piece.last; ++i) {
            result.times.push_back(all.times[piece.first + i]);
            result.read.push_back(all.readings[channel].values[piece.first + i]);
            result.left.push_back(known[k].residuals[i * channels + channel]);
        }
    }
    return result;
}

double mean_square(const std::vector<double>& values, std::size_t first, std::size_t last) {
    double sum = 0;
    for (std::size_t i = first; i < last; ++i)
        sum += values[i] * values[i];
    return sum / static_cast<double>(last - first);
}

/// Slope of the readings over the model's values if they are nearly proportional; otherwise 0.
double factor_of(const Compared& all) {
    constexpr double close = 0.9; // a correlation
    const auto count = static_cast<double>(all.read.size());
    double x = 0, y = 0, xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < all.read.size(); ++i) {
        x += (all.read[i] + all.left[i]) / count;
        y += all.read[i] / count;
    }
    for (std::size_t i = 0; i < all.read.size(); ++i) {
        const double dx = all.read[i] + all.left[i] - x, dy = all.read[i] - y;
        xx += dx * dx;
        xy += dx * dy;
        yy += dy * dy;
    }
    return xx > 0 && yy > 0 && std::abs(xy) > close * std::sqrt(xx * yy) ? xy / xx : 0;
}

} // namespace

std::vector<FitMismatch> mismatches_of(const FitRows& rows, const std::vector<PieceRows>& known) {
    constexpr double much = 0.1; // of the range; for a sine, a third of its standard deviation
    constexpr std::size_t window = 8;
    std::vector<FitMismatch> found;
    for (std::size_t r = 0; r < rows.task().records.size(); ++r)
        for (std::size_t c = 0; c < rows.task().records[r].readings.size(); ++c) {
            const Compared all = compared(rows, known, r, c);
            const std::size_t output = rows.task().records[r].readings[c].output, count = all.left.size();
            const double limit = much * rows.range(output);
            if (count < window || !(mean_square(all.left, 0, count) > limit * limit))
                continue;
            std::size_t first = 0;
            while (first + window < count && !(mean_square(all.left, first, first + window) > limit * limit))
                ++first;
            found.push_back({output, r, all.times[first],
                             std::sqrt(mean_square(all.left, 0, count)) / rows.range(output), factor_of(all)});
        }
    std::stable_sort(found.begin(), found.end(),
                     [](const FitMismatch& one, const FitMismatch& other) { return one.size > other.size; });
    return found;
}

std::string text_of(const std::vector<FitMismatch>& mismatches, const FitTask& task) {
    std::string text;
    for (const FitMismatch& one : mismatches) {
        text += fmt::format("{}'{}' ", text.empty() ? "" : "; ", task.outputs[one.output].name);
        if (task.records.size() > 1)
            text += fmt::format("of record {} ", one.record + 1);
        text += fmt::format("does not match from time {:.6g} on, by {:.2g} of its range", one.since, one.size);
        constexpr double same = 0.2;
        if (one.factor != 0 && std::abs(one.factor - 1) > same)
            text += fmt::format(" (readings are {:.3g} times what the model makes)", one.factor);
    }
    return text.empty() ? text : text + ": look at its sign, its unit and what it measures";
}

} // namespace graze
