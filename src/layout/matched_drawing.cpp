#include "graze/layout/matched_drawing.hpp"

#include "graze/base/input_error.hpp"
#include "graze/layout/lumped_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace graze {

namespace {

constexpr double atmosphere = 101325; // Pa

/// A parameter of the model, and the number of the drawing or process that determines it.
struct Way {
    const char* parameter;
    const char* section;
    const char* number;
    const char* unit;
    double DeviceDimensions::*length; ///< null: it is the pressure
    int sign;                         ///< sign of the parameter's derivative by the number
};
/// Each parameter depends most on its own number, and on those before it.
constexpr std::array matching_ways{
    Way{"d", "device", "gap", "um", &DeviceDimensions::gap, 1},
    Way{"stop", "device", "stop_gap", "um", &DeviceDimensions::stop_gap, 1},
    Way{"area", "device", "electrode_length", "um", &DeviceDimensions::electrode_length, 1},
    Way{"m", "device", "bar_width", "um", &DeviceDimensions::bar_width, 1},
    Way{"f0", "device", "flexure_length", "um", &DeviceDimensions::flexure_length, -1},
    Way{"zeta", "process", "pressure", "Pa", nullptr, 1},
};

double& number_of(DeviceFile& file, const Way& way) {
    return way.length ? file.device.*way.length : file.conditions.pressure;
}

/// A number in discrete steps: nanometres, or equal ratios of the pressure.
class Steps {
public:
    Steps(const Way& way, const DeviceFile& given) : is_length_(way.length != nullptr) {
        highest_ = is_length_ ? std::llround(greatest_length * grid_per_micrometre)
                              : place(std::max(atmosphere, given.conditions.pressure));
        lowest_ = is_length_ ? 1 : place(least_pressure);
    }
    std::int64_t place(double value) const {
        return is_length_ ? std::llround(value * grid_per_micrometre) : std::llround(std::log(value) / ratio);
    }
    double value(std::int64_t place) const {
        return is_length_ ? static_cast<double>(place) / grid_per_micrometre
                          : std::exp(static_cast<double>(place) * ratio);
    }
    std::int64_t lowest() const { return lowest_; }
    std::int64_t highest() const { return highest_; }

private:
    static constexpr double ratio = 1e-9, least_pressure = 1e-6;
    bool is_length_;
    std::int64_t lowest_ = 0, highest_ = 0;
};

class Matching {
public:
    Matching(const DeviceFile& file, const Model& designed) : model_(&designed) {
        result_.file = file;
        const LumpedModel first = lumped_model_of(file); // throws if it cannot be drawn
        for (const auto& named : parameters_of(first, designed).set) {
            const std::string& name = named.first;
            const Way& way = matching_ways[order(name)];
            MatchedQuantity one;
            const std::size_t place = *designed.find_parameter(name);
            one.parameter = name;
            one.unit = designed.parameters[place].unit;
            one.designed = *designed.parameters[place].value; // parameters_of throws for dependent ones
            one.number = fmt::format("{}.{}", way.section, way.number);
            one.number_unit = way.unit;
            one.before = number_of(result_.file, way);
            result_.quantities.push_back(one);
        }
        std::sort(result_.quantities.begin(), result_.quantities.end(),
                  [](const auto& a, const auto& b) { return order(a.parameter) < order(b.parameter); });
    }

    MatchedDrawing match() {
        constexpr int most_rounds = 60; // each round removes most of the remaining error
        bool moves = true;
        for (int round = 0; round < most_rounds && moves; ++round) {
            moves = false;
            for (std::size_t i = 0; i < matching_ways.size(); ++i)
                moves = solve(i) || moves;
        }
        const auto drawn = parameters_of(lumped_model_of(result_.file), *model_).set;
        for (MatchedQuantity& one : result_.quantities)
            for (const auto& [name, value] : drawn)
                if (name == one.parameter)
                    one.drawn = value;
        for (std::size_t i = 0; i < matching_ways.size(); ++i)
            result_.quantities[i].after = number_of(result_.file, matching_ways[i]);
        return std::move(result_);
    }

private:
    static std::size_t order(const std::string& parameter) {
        return static_cast<std::size_t>(std::find_if(matching_ways.begin(), matching_ways.end(),
                                                     [&](const Way& way) { return parameter == way.parameter; }) -
                                        matching_ways.begin());
    }

    /// Deviation of the parameter from the designed value, signed so that it increases with the number. Empty if the
    /// device cannot be drawn; `refusal_` says why.
    std::optional<double> departure(std::size_t which, double number) {
        const Way& way = matching_ways[which];
        DeviceFile trial = result_.file;
        number_of(trial, way) = number;
        try {
            for (const auto& [name, value] : parameters_of(lumped_model_of(trial), *model_).set)
                if (name == way.parameter)
                    return way.sign * (value - result_.quantities[which].designed);
        } catch (const InputError& error) {
            refusal_ = error.problem();
        }
        return std::nullopt;
    }

    /// Solves for one number. @return whether it has changed
    bool solve(std::size_t which) {
        const Way& way = matching_ways[which];
        MatchedQuantity& quantity = result_.quantities[which];
        double& number = number_of(result_.file, way);
        if (is_given_place(result_.file.place(quantity.number))) {
            quantity.met = departure(which, number).value_or(1) == 0;
            quantity.reason = fmt::format("{} is given", way.number);
            return false;
        }
        const std::optional<double> here = departure(which, number);
        quantity.met = here && *here == 0;
        quantity.reason = here ? "" : refusal_; // because an earlier number has changed
        if (!here || quantity.met)
            return false;
        const Steps steps(way, result_.file);
        const std::int64_t start = steps.place(number), found = nearest(which, steps, {start, *here});
        if (found == start)
            return false;
        number = steps.value(found);
        return true;
    }

    struct Tried {
        std::int64_t place;
        double departure;
    };

    /// Steps of growing size until the designed value is bracketed, then bisection. If it cannot be bracketed, the last
    /// number that can be drawn.
    std::int64_t nearest(std::size_t which, const Steps& steps, Tried near) {
        const bool up = near.departure < 0;
        const std::int64_t end = up ? steps.highest() : steps.lowest();
        std::int64_t step = up ? 1 : -1;
        bool refused = false;
        refusal_.clear();
        while (true) {
            const std::int64_t place = up ? std::min(near.place + step, end) : std::max(near.place + step, end);
            const std::optional<double> departs =
                place == near.place ? std::nullopt : departure(which, steps.value(place));
            if (departs && (*departs < 0) != up)
                return between(which, steps, near, {place, *departs});
            if (!departs && std::abs(place - near.place) <= 1) {
                say_end(which, steps.value(near.place), up);
                return near.place;
            }
            if (departs)
                near = {place, *departs};
            refused = refused || !departs;
            constexpr std::int64_t faster = 4;
            step = !refused ? faster * step : step / 2 != 0 ? step / 2 : up ? 1 : -1;
        }
    }

    std::int64_t between(std::size_t which, const Steps& steps, Tried a, Tried b) {
        while (std::abs(b.place - a.place) > 1) {
            const std::int64_t middle = a.place + (b.place - a.place) / 2;
            const std::optional<double> departs = departure(which, steps.value(middle));
            if (!departs)
                break;
            ((*departs < 0) == (a.departure < 0) ? a : b) = {middle, *departs};
        }
        result_.quantities[which].met = true;
        return std::abs(a.departure) <= std::abs(b.departure) ? a.place : b.place;
    }

    void say_end(std::size_t which, double last, bool up) {
        MatchedQuantity& quantity = result_.quantities[which];
        const std::string why = !refusal_.empty()             ? refusal_
                                : matching_ways[which].length ? "nothing is drawn beyond"
                                : up                          ? "more than an atmosphere takes a vessel of its own"
                                                              : "less is no gas";
        quantity.reason = fmt::format("{} would have to be {} than {:.6g} {}, and {}", quantity.number,
                                      up ? "more" : "less", last, quantity.number_unit, why);
    }

    const Model* model_;
    MatchedDrawing result_;
    std::string refusal_;
};

} // namespace

bool MatchedDrawing::is_met() const {
    return std::all_of(quantities.begin(), quantities.end(), [](const MatchedQuantity& one) { return one.met; });
}

MatchedDrawing match_drawing(const DeviceFile& file, const Model& designed) {
    return Matching(file, designed).match();
}

} // namespace graze
