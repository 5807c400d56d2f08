#include "identify/fit_findings.hpp"

#include "base/median.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

/// Relative accuracy of readings, at best.
constexpr double negligible_change = 1e-12;

/// Residuals of all readings, by output and by record, in the order of records and times.
struct Residuals {
    std::vector<std::vector<double>> of_output;
    std::vector<std::vector<std::vector<double>>> of_record; ///< record, readings, times
};

Residuals residuals_of(const FitRows& rows, const std::vector<PieceRows>& known) {
    const FitTask& task = rows.task();
    Residuals residuals;
    residuals.of_output.resize(task.outputs.size());
    for (const FitRecord& record : task.records)
        residuals.of_record.emplace_back(record.readings.size());
    for (std::size_t k = 0; k < rows.layout.pieces.size(); ++k) {
        const FitPiece& piece = rows.layout.pieces[k];
        const auto& readings = task.records[piece.record].readings;
        for (std::size_t i = 0; i < known[k].residuals.size(); ++i)
            residuals.of_record[piece.record][i % readings.size()].push_back(known[k].residuals[i]);
    }
    for (std::size_t r = 0; r < task.records.size(); ++r)
        for (std::size_t c = 0; c < task.records[r].readings.size(); ++c) {
            auto& all = residuals.of_output[task.records[r].readings[c].output];
            all.insert(all.end(), residuals.of_record[r][c].begin(), residuals.of_record[r][c].end());
        }
    return residuals;
}

/// Degrees of freedom: readings less unknowns.
double freedom_of(const FitTask& task) {
    return static_cast<double>(readings_of(task)) - static_cast<double>(unknowns_of(task));
}

double square_sum(const std::vector<double>& values) {
    return std::transform_reduce(values.begin(), values.end(), 0.0, std::plus<>(), [](double x) { return x * x; });
}

bool is_at_bound(const FitRows& rows, const FitPoint& point, std::size_t parameter) {
    const UnknownParameter& unknown = rows.task().parameters[parameter];
    const auto column = static_cast<Eigen::Index>(parameter);
    const double scale = rows.layout.shared_scale[column], value = point.shared[column] * scale, near = 1e-9 * scale;
    return value - unknown.least <= near || unknown.greatest - value <= near;
}

/// The fitted numbers in the order of FitInformation: initial states first, then shared ones.
std::vector<FittedNumber> numbers_at(const FitRows& rows, const FitPoint& point, std::vector<double>& scales) {
    const FitTask& task = rows.task();
    const FitLayout& layout = rows.layout;
    const Model& model = rows.system().model();
    std::vector<FittedNumber> numbers;
    for (std::size_t k = 0; k < layout.pieces.size(); ++k)
        for (Eigen::Index c = 0; layout.pieces[k].is_first && c < point.states[k].size(); ++c) {
            const std::size_t r = layout.pieces[k].record, i = layout.state_of(task, layout.pieces[k], c);
            const std::string of_record = task.records.size() == 1 ? "" : fmt::format(" of record {}", r + 1);
            scales.push_back(layout.state_scale[static_cast<Eigen::Index>(i)]);
            numbers.push_back({FittedNumber::Kind::state,
                               model.states[i].name + "(0)" + of_record,
                               model.states[i].unit,
                               r,
                               i,
                               {point.states[k][c] * scales.back(), 0, 0}});
        }
    const std::size_t states = numbers.size();
    Eigen::Index column = 0;
    const auto add = [&](FittedNumber::Kind kind, const std::string& name, const std::string& unit, std::size_t index) {
        scales.push_back(layout.shared_scale[column]);
        numbers.push_back({kind, name, unit, 0, index, {point.shared[column++] * scales.back(), 0, 0}});
    };
    const std::vector<std::string> names = model.independent_parameters();
    for (const UnknownParameter& unknown : task.parameters) {
        const std::string& name = names[unknown.parameter.place()];
        add(FittedNumber::Kind::parameter, name, model.parameter_unit(name), unknown.parameter.place());
        numbers.back().at_bound = is_at_bound(rows, point, numbers.size() - 1 - states);
    }
    for (const std::size_t output : layout.gains)
        add(FittedNumber::Kind::gain, "gain of " + task.outputs[output].name, "", output);
    for (const std::size_t output : layout.offsets)
        add(FittedNumber::Kind::offset, "offset of " + task.outputs[output].name, "", output);
    return numbers;
}

/// The variance of the rows' noise; for robust losses the factor that replaces it in the covariance (Huber, chapter 7).
double variance_of_residuals(const FitRows& rows, const Residuals& residuals, double freedom) {
    constexpr double huber = 1.345, cauchy = 2.385;
    double squares = 0, slopes = 0, count = 0;
    for (std::size_t o = 0; o < residuals.of_output.size(); ++o)
        for (const double residual : residuals.of_output[o]) {
            const double u = residual / rows.noise[o];
            double pull = u, slope = 1;
            if (rows.loss() == FitLoss::huber && std::abs(u) > huber) {
                pull = std::copysign(huber, u);
                slope = 0;
            } else if (rows.loss() == FitLoss::cauchy) {
                const double part = 1 + u * u / (cauchy * cauchy);
                pull = u / part;
                slope = (2 - part) / (part * part);
            }
            const double rounded = negligible_change * rows.range(o) / rows.noise[o];
            squares += pull * pull + rounded * rounded;
            slopes += slope;
            count += 1;
        }
    const double mean = slopes / count, unit = rows.unit();
    return mean > 0 ? unit * unit * squares / freedom / (mean * mean) : 0;
}

FreeCombination combination(const FitDecomposition& parts, Eigen::Index k, const std::vector<FittedNumber>& numbers,
                            const std::vector<double>& scales, const std::vector<std::size_t>& order) {
    constexpr double least = 0.01, negligible = 1e-6;
    FreeCombination result;
    result.strength = parts.values[0] > 0 ? parts.values[k] / parts.values[0] : 0;
    std::vector<FreeCombination::Part> all;
    double largest = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        const double length = parts.lengths[c] > 0 ? parts.lengths[c] : 1, value = numbers[order[i]].estimate.value;
        const double change = parts.directions(c, k) / length;
        all.push_back({order[i], std::abs(value) > negligible * scales[i] ? change * scales[i] / value : change});
        largest = std::abs(all.back().change) > std::abs(largest) ? all.back().change : largest;
    }
    for (FreeCombination::Part part : all) {
        part.change = largest != 0 ? part.change / largest : 0;
        if (std::abs(part.change) >= least)
            result.parts.push_back(part);
    }
    std::stable_sort(result.parts.begin(), result.parts.end(),
                     [](const auto& one, const auto& other) { return std::abs(one.change) > std::abs(other.change); });
    for (const FreeCombination::Part& part : result.parts)
        result.text +=
            fmt::format("{}{} ({:+.3g} %)", result.text.empty() ? "" : ", ", numbers[part.number].name, part.change);
    return result;
}

void describe_outputs(const FitRows& rows, const Residuals& residuals, Fit& fit) {
    constexpr double chance = 4, far = 5;
    const FitTask& task = rows.task();
    const double freed = fit.freedom / static_cast<double>(fit.readings);
    for (std::size_t o = 0; o < task.outputs.size(); ++o) {
        FittedOutput output;
        output.name = task.outputs[o].name;
        const std::vector<double>& all = residuals.of_output[o];
        output.readings = all.size();
        if (all.empty()) {
            fit.outputs.push_back(std::move(output));
            continue;
        }
        const auto count = static_cast<double>(all.size());
        const double squares = square_sum(all);
        output.deviation = std::sqrt(squares / (count * freed));
        double sum = 0, spread = 0, products = 0, pairs = 0;
        for (std::size_t r = 0; r < task.records.size(); ++r)
            for (std::size_t c = 0; c < task.records[r].readings.size(); ++c) {
                if (task.records[r].readings[c].output != o)
                    continue;
                const std::vector<double>&left = residuals.of_record[r][c],
                      &values = task.records[r].readings[c].values;
                sum = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
                for (const double value : values)
                    spread += (value - sum) * (value - sum);
                for (std::size_t i = 1; i < left.size(); ++i) {
                    products += left[i] * left[i - 1];
                    pairs += 1;
                }
            }
        output.unchanging = spread == 0;
        output.share = spread > 0 ? 1 - squares / spread : 0;
        output.correlation = squares > 0 ? products / squares : 0;
        output.independent = std::abs(output.correlation) * std::sqrt(std::max(pairs, 1.0)) <= chance;
        if (task.outputs[o].noise > 0)
            output.chi_square = squares / (task.outputs[o].noise * task.outputs[o].noise * count * freed);
        output.outliers = static_cast<std::size_t>(std::count_if(
            all.begin(), all.end(), [&](double residual) { return std::abs(residual) > far * output.deviation; }));
        fit.outputs.push_back(std::move(output));
    }
}

/// Standard deviation of an output: the given one, or that of its residuals.
double noise_of_output(const FitRows& rows, std::size_t output, std::vector<double> residuals) {
    if (const double given = rows.task().outputs[output].noise; given > 0)
        return given;
    const double freed = freedom_of(rows.task()) / static_cast<double>(readings_of(rows.task()));
    double noise = std::sqrt(square_sum(residuals) / (static_cast<double>(residuals.size()) * freed));
    if (rows.loss() != FitLoss::squares) { // the median is insensitive to outliers
        constexpr double of_normal = 1.4826;
        for (double& residual : residuals)
            residual = std::abs(residual);
        noise = of_normal * median(std::move(residuals)) / std::sqrt(freed);
    }
    return std::max(noise, negligible_change * rows.range(output));
}

/// Fills in numbers with errors and correlations, and undetermined combinations.
void describe_numbers(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint,
                      double variance, Fit& fit) {
    std::vector<double> scales;
    std::vector<FittedNumber> numbers = numbers_at(rows, point, scales);
    std::vector<bool> held;
    for (const FittedNumber& number : numbers)
        held.push_back(number.at_bound);
    // Results list parameters first; FitInformation lists states first.
    const std::size_t shared = static_cast<std::size_t>(rows.layout.shared()), states = numbers.size() - shared;
    std::vector<std::size_t> order(numbers.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i < states ? shared + i : i - states;
    const FitDecomposition parts = decompose(information_of(rows, point, known, joint), held);
    fit.numbers.resize(numbers.size());
    fit.correlations.assign(numbers.size() * numbers.size(), 0.0);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        if (parts.known[i]) {
            numbers[i].estimate.error = scales[i] * std::sqrt(variance * parts.covariance(c, c));
            if (rows.robust && rows.loss() == FitLoss::squares) // the remaining step at the edge of a contact
                numbers[i].estimate.error = std::hypot(numbers[i].estimate.error, scales[i] * parts.step[c]);
            numbers[i].estimate.freedom = fit.freedom;
            for (std::size_t j = 0; j < numbers.size(); ++j) {
                const auto d = static_cast<Eigen::Index>(j);
                if (parts.known[j])
                    fit.correlations[order[i] * numbers.size() + order[j]] =
                        parts.covariance(c, d) / std::sqrt(parts.covariance(c, c) * parts.covariance(d, d));
            }
        }
    }
    for (std::size_t i = 0; i < numbers.size(); ++i)
        fit.numbers[order[i]] = std::move(numbers[i]);
    const auto determined =
        static_cast<std::size_t>(std::count(parts.determined.begin(), parts.determined.end(), true));
    const auto bound = static_cast<std::size_t>(std::count(held.begin(), held.end(), true));
    fit.condition = determined > 0 ? parts.values[0] / parts.values[static_cast<Eigen::Index>(determined) - 1] : 0;
    for (std::size_t k = determined; k + bound < parts.determined.size(); ++k)
        if (FreeCombination free = combination(parts, static_cast<Eigen::Index>(k), fit.numbers, scales, order);
            !free.parts.empty())
            fit.free.push_back(std::move(free));
}

} // namespace

void describe(FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint, Fit& fit) {
    const FitTask& task = rows.task();
    fit.records.assign(task.records.size(), {});
    const Residuals residuals = residuals_of(rows, known);
    fit.readings = readings_of(task);
    fit.freedom = freedom_of(task);
    fit.pieces = rows.layout.pieces.size();
    for (std::size_t r = 0; r < task.records.size(); ++r)
        for (std::size_t c = 0; c < task.records[r].readings.size(); ++c) {
            std::vector<double> fitted = task.records[r].readings[c].values;
            for (std::size_t i = 0; i < fitted.size(); ++i)
                fitted[i] += residuals.of_record[r][c][i];
            fit.records[r].fitted.push_back(std::move(fitted));
        }
    for (std::size_t k = 0; k < rows.layout.pieces.size(); ++k) {
        const FitPiece& piece = rows.layout.pieces[k];
        FittedRecord& record = fit.records[piece.record];
        record.contacts += known[k].contacts;
        record.misplaced += known[k].misplaced;
        if (piece.is_first)
            record.start = rows.first_state(piece, point.shared, point.states[k]);
        else
            record.joints.push_back(piece.begin);
    }
    fit.parameters = task.values.empty() ? rows.system().model().parameter_values() : task.values;
    for (std::size_t j = 0; j < task.parameters.size(); ++j)
        fit.parameters[task.parameters[j].parameter.place()] =
            point.shared[static_cast<Eigen::Index>(j)] * rows.layout.shared_scale[static_cast<Eigen::Index>(j)];
    describe_outputs(rows, residuals, fit);
    const double variance = variance_of_residuals(rows, residuals, fit.freedom);
    if (rows.loss() == FitLoss::squares)
        return describe_numbers(rows, point, known, joint, variance, fit);
    rows.robust = false; // the covariance is that of least squares, times the variance for the loss
    describe_numbers(rows, point, rows.evaluate(point), joint, variance, fit);
    rows.robust = true;
}

std::string unreadable(const FitRows& rows, const std::vector<PieceRows>& known) {
    for (std::size_t k = 0; k < known.size(); ++k) {
        const FitPiece& piece = rows.layout.pieces[k];
        if (!known[k].finite && !known[k].detail.empty())
            return fmt::format("no motion begins at time {:.6g} ({}): begin from other guesses, or with longer pieces",
                               piece.begin, known[k].detail);
        if (!known[k].finite)
            return fmt::format("the model's values for readings from time {:.6g} to {:.6g} are not finite: check "
                               "the outputs, begin from other guesses, or bound parameters",
                               piece.begin, piece.end);
    }
    return {};
}

FitChecks check_point(const FitRows& rows, const FitPoint& point, const std::vector<PieceRows>& known, double joint) {
    constexpr double negligible = 1e-9, part_of_noise = 1e-3;
    FitChecks checks;
    double squares = 0;
    const std::vector<FitPiece>& pieces = rows.layout.pieces;
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        const PieceRows& piece = known[k];
        squares += piece.squares();
        if (!piece.complete && checks.broken.empty())
            checks.broken = piece.detail;
        if (!pieces[k].has_next)
            continue;
        checks.gap = std::max(checks.gap, rows.gap(piece, point.states[k + 1]).lpNorm<Eigen::Infinity>());
        checks.modes_agree = checks.modes_agree && piece.end_mode == pieces[k + 1].mode;
    }
    const double size = std::sqrt(squares / freedom_of(rows.task()));
    checks.allowed_gap = std::max(negligible, part_of_noise * size);
    const FitInformation information = information_of(rows, point, known, joint);
    const Eigen::Index count = information.rows.cols() - 1, first = count - rows.layout.shared();
    const std::vector<int> bounded = parameters_at_bounds(rows, point);
    std::vector<bool> held(static_cast<std::size_t>(count));
    for (const int j : bounded)
        held[static_cast<std::size_t>(first + j)] = true;
    const FitDecomposition parts = decompose(information, held);
    // At a bound the sum of squares must decrease towards the outside.
    bool beyond = true;
    for (const int j : bounded) {
        const UnknownParameter& unknown = rows.task().parameters[static_cast<std::size_t>(j)];
        const double value = point.shared[j] * rows.layout.shared_scale[j];
        const double slope = information.rows.col(first + j).dot(information.rows.col(count));
        beyond = beyond && (unknown.greatest - value < value - unknown.least ? slope <= 0 : slope >= 0);
    }
    checks.remaining_step = parts.step.size() == 0 || parts.step.lpNorm<Eigen::Infinity>() <= negligible
                                ? 0
                                : std::sqrt(parts.gain + information.eliminated) / size;
    checks.bounds_hold = beyond;
    return checks;
}

std::vector<int> parameters_at_bounds(const FitRows& rows, const FitPoint& point) {
    std::vector<int> bounded;
    for (std::size_t j = 0; j < rows.task().parameters.size(); ++j)
        if (is_at_bound(rows, point, j))
            bounded.push_back(static_cast<int>(j));
    return bounded;
}

double negative_log_likelihood(const FitRows& rows, const std::vector<PieceRows>& known) {
    const Residuals residuals = residuals_of(rows, known);
    double sum = 0;
    for (std::size_t o = 0; o < residuals.of_output.size(); ++o) {
        if (residuals.of_output[o].empty())
            continue;
        const double noise = noise_of_output(rows, o, residuals.of_output[o]);
        sum += static_cast<double>(residuals.of_output[o].size()) * std::log(noise / rows.range(o));
        for (const double residual : residuals.of_output[o])
            sum += 0.5 * cost_of(residual / noise, rows.loss());
    }
    return sum;
}

bool is_exact(const FitRows& rows, const std::vector<PieceRows>& known) {
    constexpr double negligible = 1e-9;
    const Residuals residuals = residuals_of(rows, known);
    for (std::size_t o = 0; o < residuals.of_output.size(); ++o)
        for (const double residual : residuals.of_output[o])
            if (!(std::abs(residual) <= negligible * rows.range(o)))
                return false;
    return true;
}

std::vector<double> noise_at(const FitRows& rows, const std::vector<PieceRows>& known) {
    const Residuals residuals = residuals_of(rows, known);
    std::vector<double> noise = rows.noise;
    for (std::size_t o = 0; o < noise.size(); ++o)
        if (!residuals.of_output[o].empty())
            noise[o] = noise_of_output(rows, o, residuals.of_output[o]);
    return noise;
}

} // namespace graze
