#include "graze/layout/lumped_model.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/physical_unit.hpp"
#include "graze/base/with_place.hpp"
#include "graze/layout/folded_spring.hpp"
#include "graze/layout/plate_attraction.hpp"
#include "graze/layout/squeeze_film.hpp"
#include "graze/model/catalogue.hpp"
#include "layout/grid_lengths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace graze {

namespace {

constexpr double micrometre = 1e-6; // m

EtchedWidth in_metres(const EtchedWidth& width) {
    return {width.top * micrometre, width.bottom * micrometre};
}

class Lumping {
public:
    Lumping(const DeviceDrawing& drawing, const ProcessData& process, const ProcessConditions& conditions)
        : drawing_(&drawing), conditions_(&conditions), wall_(conditions.wall()), depth_(process.layer_thickness()),
          chamber_(process.chamber_depth) {}

    LumpedModel lump(double stop_departure) const {
        LumpedModel result;
        add_springs(result);
        add_plates(result);
        add_stops(result, stop_departure);
        const double plate = etched_area(drawing_->mass, wall_, depth_) * micrometre * micrometre;
        result.plate_mass = conditions_->density * plate * depth_ * micrometre;
        result.mass += result.plate_mass;
        result.chamber_film = sliding_film_damping(plate, chamber_ * micrometre, conditions_->gas());
        result.damping = result.electrode_film + result.stop_films + result.chamber_film;
        result.squeeze =
            squeeze_number(electrode_film(), conditions_->gas(), 2 * std::numbers::pi * result.frequency());
        return result;
    }

private:
    double recess() const { return wall_.mean_recess(depth_); }
    EtchedWidth line(std::int64_t drawn) const { return etched_line(wall_, micrometres(drawn), depth_); }
    EtchedWidth trench(std::int64_t drawn) const { return etched_trench(wall_, micrometres(drawn), depth_); }

    /// Adds the springs: both flexures have two halves.
    void add_springs(LumpedModel& result) const {
        const FlexureDrawing& flexure = drawing_->flexure;
        const std::size_t count = flexure.beams.size() / 2;
        const GridBox &beam = flexure.beams[count], &next = flexure.beams[count + 1],
                      &mirrored = flexure.beams[count - 1];
        FoldedSpring spring;
        spring.beams = count;
        spring.beam_length = (micrometres(beam.height()) + 2 * recess()) * micrometre;
        spring.beam_width = in_metres(line(beam.width()));
        spring.spacing = (micrometres(next.left - beam.right) + 2 * recess()) * micrometre;
        spring.half_middle = 0.5 * (micrometres(beam.left - mirrored.right) + 2 * recess()) * micrometre;
        spring.truss_width = in_metres(line(flexure.trusses.front().height()));
        spring.height = depth_ * micrometre;
        spring.modulus = conditions_->modulus * 1e9;
        const DeviceDimensions& d = drawing_->dimensions;
        spring.finger_length = (micrometres(flexure.finger.height()) + d.clearance) * micrometre;
        const double rigid_mass = properties_of(spring).stiffness;
        spring.bar_length = (micrometres(flexure.lugs.front().bottom) + 2 * recess()) * micrometre;
        spring.bar_width = in_metres(etched_line(wall_, d.bar_width, depth_));
        const SpringProperties half = properties_of(spring);
        constexpr double halves = 4;
        result.rigid_mass = halves * rigid_mass;
        result.stiffness = halves * half.stiffness;
        result.stiff_trusses = halves * half.stiff_trusses;
        result.stress_per_travel = half.stress_per_travel;
        result.mass = halves * half.moving_area * spring.height * conditions_->density;
    }

    /// Film between electrode and mass.
    GasFilm electrode_film() const { return film_between(drawing_->electrode, drawing_->mass, 0); }

    GasFilm film_between(const GridPolygon& left, const GridPolygon& right, double departure) const {
        const auto between = facing(left, right);
        if (!between)
            throw InputError("two electrodes or stops do not face each other", "move them");
        const EtchedWidth gap = trench(between->distance);
        return {(micrometres(between->length) - 2 * recess()) * micrometre, depth_ * micrometre,
                in_metres({gap.top + departure, gap.bottom + departure})};
    }

    void add_plates(LumpedModel& result) const {
        const GasFilm film = electrode_film();
        const DeviceDimensions& d = drawing_->dimensions;
        const double behind = std::min(d.bar_width, d.electrode_width) - 2 * recess();
        const EquivalentPlates plates = equivalent_plates(
            {.length = film.length, .height = film.height, .backing = behind * micrometre, .gap = film.gap});
        result.area = plates.area;
        result.gap = plates.gap;
        result.closure = film.gap.least();
        result.electrode_film = squeeze_film_damping(film, conditions_->gas());
    }

    void add_stops(LumpedModel& result, double departure) const {
        result.stop = greatest_length;
        for (const GridPolygon& stop : drawing_->stops) {
            const GasFilm film = film_between(drawing_->mass, stop, departure);
            result.stop = std::min(result.stop, film.gap.least());
            result.stop_films += squeeze_film_damping(film, conditions_->gas());
        }
    }

    const DeviceDrawing* drawing_;
    const ProcessConditions* conditions_;
    EtchedWall wall_;
    double depth_, chamber_; // um
};

/// Place to report when the etch removes a part: a number given beside the file, else the etch, else the largest
/// contribution.
Place place_of_etch(const DeviceFile& file) {
    const double by_taper = file.conditions.wall().slope * file.process.layer_thickness();
    const bool tapered = std::abs(by_taper) > std::abs(file.conditions.bias);
    for (const char* key : {tapered ? "process.taper" : "process.bias", tapered ? "process.bias" : "process.taper"})
        if (const Place place = file.place(key); is_given_place(place))
            return place;
    for (const auto& [key, place] : file.places)
        if (is_given_place(place))
            return place;
    return file.place(tapered ? "process.taper" : "process.bias");
}

} // namespace

double LumpedModel::frequency() const {
    return std::sqrt(stiffness / mass) / (2 * std::numbers::pi);
}

double LumpedModel::damping_ratio() const {
    return damping / (2 * std::sqrt(stiffness * mass));
}

double LumpedModel::pull_in() const {
    return gap * std::sqrt(8 * stiffness * (gap / area) / (27 * vacuum_permittivity));
}

double etched_area(std::span<const GridPoint> corners, const EtchedWall& wall, double depth) {
    // Receding edges by r reduce the area by r times their length; corners of turning angle t give r^2 tan(t/2) back.
    double perimeter = 0, corner_sum = 0, turning = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const GridPoint &a = corners[i], &b = corners[(i + 1) % corners.size()], &c = corners[(i + 2) % corners.size()];
        const double ux = micrometres(b.x - a.x), uy = micrometres(b.y - a.y), vx = micrometres(c.x - b.x),
                     vy = micrometres(c.y - b.y);
        perimeter += std::hypot(ux, uy);
        const double turn = std::atan2(ux * vy - uy * vx, ux * vx + uy * vy);
        corner_sum += std::tan(0.5 * turn);
        turning += turn;
    }
    const double top = wall.recess(0), bottom = wall.recess(depth);
    const double square = (top * top + top * bottom + bottom * bottom) / 3;
    return area_of(corners) - perimeter * wall.mean_recess(depth) + std::copysign(1.0, turning) * corner_sum * square;
}

LumpedModel lumped_model_of(const DeviceDrawing& drawing, const ProcessData& process,
                            const ProcessConditions& conditions, double stop_departure) {
    return Lumping(drawing, process, conditions).lump(stop_departure);
}

LumpedModel lumped_model_of(const DeviceFile& file) {
    return lumped_model_of(draw_device(file), file);
}

LumpedModel lumped_model_of(const DeviceDrawing& drawing, const DeviceFile& file) {
    try {
        return lumped_model_of(drawing, file.process, file.conditions);
    } catch (const InputError& error) {
        throw InputError(
            place_of_etch(file), error.problem(),
            "draw it larger, or give another bias, taper or thickness, so that the etch leaves some of it");
    }
}

Model model_of(const DeviceFile& file) {
    return with_place(file.place("model"), [&] { return load_model(file.model); });
}

ParameterFile parameters_of(const LumpedModel& lumped, const Model& model) {
    const std::tuple<const char*, const char*, double> all[] = {
        {"m", "kg", lumped.mass},     {"f0", "Hz", lumped.frequency()}, {"zeta", "", lumped.damping_ratio()},
        {"area", "m^2", lumped.area}, {"d", "m", lumped.gap},           {"stop", "m", lumped.stop}};
    ParameterFile file;
    file.model = model.name;
    for (const auto& [name, unit, value] : all) {
        const auto place = model.find_parameter(name);
        if (!place || model.parameters[*place].expression)
            throw InputError(fmt::format("the model {} has no parameter '{}' to be set", model.name, name),
                             "name a model of a switch with m, f0, zeta, area, d and stop, as mems-switch-device");
        const std::string& wanted = model.parameters[*place].unit;
        const auto convert = [&, from = unit, number = value] {
            return converted(number, physical_unit(from), physical_unit(wanted));
        };
        file.set.emplace_back(
            name,
            with_place({}, convert, fmt::format("'{}' of the model {} has the unit '{}': ", name, model.name, wanted)));
    }
    return file;
}

} // namespace graze
