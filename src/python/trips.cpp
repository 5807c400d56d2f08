#include "graze/base/input_error.hpp"
#include "graze/model/named_value.hpp"
#include "graze/picture/trip_series.hpp"
#include "graze/results/name_advice.hpp"
#include "graze/results/touching_orbit.hpp"
#include "graze/results/trip_table.hpp"
#include "graze/trip/trip_request.hpp"
#include "python/analysis_progress.hpp"
#include "python/figures.hpp"
#include "python/tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace graze::python {

namespace {

/// A point at which a motion is lost, and what ends its trips.
class HeldLossPoint {
public:
    HeldLossPoint(const ResultFile& file, const std::string& point, const std::string& parameter,
                  const std::optional<std::string>& until, std::optional<double> greatest_speed) {
        attended([&](const std::function<bool()>&) {
            const StoredOrbit stored = find_closed_orbit(file, point, of_point);
            title_ = title_of(stored.record);
            point_ = std::make_shared<const LossPoint>(loss_point(stored, parameter, of_point, of_parameter));
            end_ = greatest_speed ? end_at_speed(*point_, *greatest_speed)
                   : until        ? read_end(*point_, *until, "until")
                                  : usual_end(*point_);
        });
    }

    const LossPoint& point() const { return *point_; }
    const NamedEnd& end() const { return end_; }
    const std::string& title() const { return title_; }
    const Model& model() const { return point_->model(); }

private:
    std::string title_;
    std::shared_ptr<const LossPoint> point_;
    NamedEnd end_;
};

/// Trips while they are computed, and after. What has been computed stays when it is interrupted.
class Trips {
public:
    explicit Trips(const HeldLossPoint& from) : from_(from), progress_(from.title()) {}
    virtual ~Trips() = default;
    Trips(const Trips&) = delete;
    Trips& operator=(const Trips&) = delete;

    void compute(const py::object& told) {
        progress_.begin(steps());
        attended([&](const std::function<bool()>& must_stop) { compute_until(must_stop); }, progress_.telling(told));
    }
    virtual Table table() const = 0;
    virtual Figure figure() const = 0;
    virtual std::vector<std::string> unfinished() const = 0;
    virtual std::size_t rows() const = 0;
    virtual std::size_t wanted() const = 0;

protected:
    virtual void compute_until(const std::function<bool()>& must_stop) = 0;
    virtual std::size_t steps() const { return wanted(); }

    const LossPoint& point() const { return from_.point(); }
    const NamedEnd& end() const { return from_.end(); }
    const HeldLossPoint& from() const { return from_; }
    void note(std::size_t done) { progress_.note(done); }
    std::vector<double> numbers(const std::vector<std::string>& items, const char* argument) const {
        std::vector<double> values = numbers_by_decades(point().model(), items, argument);
        if (values.empty())
            throw InputError(Place{argument, 0, 0}, "no numbers are given", "give one or several");
        return values;
    }

private:
    HeldLossPoint from_;
    AnalysisProgress progress_;
};

constexpr const char* longer = "give more cycles, or another end by until";

TripOptions options_of(double cycles, const std::function<bool()>& must_stop) {
    TripOptions options;
    options.cycles = cycles;
    options.interrupted = must_stop;
    return options;
}

/// The disturbance of each state; empty if none is given.
std::vector<double> disturbance_of(const Model& model, const std::vector<std::pair<std::string, std::string>>& given) {
    std::vector<double> values(given.empty() ? 0 : model.states.size(), 0.0);
    for (const auto& [name, text] : given) {
        const auto state = model.find_state(name);
        if (!state)
            throw InputError({"disturbance", 0, 0}, fmt::format("'{}' is not a state", name),
                             name_advice(name, names_of(model.states), ""));
        values[*state] = value_of(model, text, "disturbance");
    }
    return values;
}

/// Trips beyond a point, and beside it of another one, with the parameter moved at once.
class TripsBeyond : public Trips {
public:
    TripsBeyond(const HeldLossPoint& from, const HeldLossPoint* beside,
                const std::optional<std::vector<std::string>>& overshoots, double cycles,
                const std::vector<std::pair<std::string, std::string>>& disturbance)
        : Trips(from), cycles_(cycles) {
        overshoots_ = overshoots ? numbers(*overshoots, "overshoot") : usual_overshoots(point().value, point().side);
        add(from, disturbance);
        if (beside)
            add(*beside, disturbance);
    }

    Table table() const override {
        return all_.size() > 1 ? trip_table(all_.front(), all_.back()) : trip_table(all_.front());
    }
    Figure figure() const override {
        if (std::ranges::all_of(overshoots_, [](double one) { return one == 0; }))
            throw InputError("an overshoot of zero has no place on a logarithmic axis",
                             "give others to be drawn beside it");
        return trip_figure(all_);
    }
    std::vector<std::string> unfinished() const override {
        std::vector<std::string> messages;
        for (const OvershootTrips& one : all_)
            std::ranges::copy(unfinished_trips(one, longer), std::back_inserter(messages));
        return messages;
    }
    std::size_t rows() const override { return std::ranges::min_element(all_, {}, &OvershootTrips::size)->size(); }
    std::size_t wanted() const override { return overshoots_.size(); }

private:
    void add(const HeldLossPoint& from, const std::vector<std::pair<std::string, std::string>>& disturbance) {
        all_.push_back({from.point(), from.end()});
        disturbances_.push_back(disturbance_of(from.model(), disturbance));
    }
    std::size_t steps() const override { return all_.size() * overshoots_.size(); }
    void compute_until(const std::function<bool()>& must_stop) override {
        std::size_t done = 0;
        for (std::size_t i = 0; i < all_.size(); ++i)
            for (const double asked : overshoots_) {
                OvershootTrips& all = all_[i];
                const double overshoot = i == 0 ? asked : all.point.side * std::abs(asked);
                TripOptions options = options_of(cycles_, must_stop);
                options.disturbance = disturbances_[i];
                const OvershootTrips one = with_place(
                    {"overshoot", 0, 0}, [&] { return overshoot_trips(all.point, all.end, {overshoot}, options); });
                if (one.interrupted)
                    return;
                std::ranges::copy(one.of_touch, std::back_inserter(all.of_touch));
                std::ranges::copy(one.of_fold, std::back_inserter(all.of_fold));
                note(++done);
            }
    }

    std::vector<double> overshoots_;
    double cycles_;
    std::vector<OvershootTrips> all_;
    std::vector<std::vector<double>> disturbances_;
};

/// Trips with the parameter changing in time.
class DisturbedTrips : public Trips {
public:
    DisturbedTrips(const HeldLossPoint& from, const std::vector<std::string>& asked, const char* argument,
                   const std::optional<std::string>& at)
        : Trips(from), asked_(numbers(asked, argument)), argument_(argument) {
        if (at)
            at_ = value_of(point().model(), *at, "at");
    }
    std::size_t wanted() const override { return asked_.size(); }

protected:
    const std::vector<double>& asked() const { return asked_; }
    const char* argument() const { return argument_; }
    const std::optional<double>& at() const { return at_; }
    TripOrigin origin() const {
        return with_place({"at", 0, 0}, [&] { return trip_origin(point(), at_.value()); });
    }

private:
    std::vector<double> asked_;
    const char* argument_;
    std::optional<double> at_;
};

class RampTrips : public DisturbedTrips {
public:
    RampTrips(const HeldLossPoint& from, const std::vector<std::string>& rates, const std::optional<std::string>& at,
              double cycles)
        : DisturbedTrips(from, rates, "ramp", at), cycles_(cycles) {}

    Table table() const override { return ramp_table(point(), rows_); }
    Figure figure() const override { return ramp_figure(point(), rows_, end().words); }
    std::vector<std::string> unfinished() const override { return unfinished_trips(rows_, longer); }
    std::size_t rows() const override { return rows_.size(); }

private:
    void compute_until(const std::function<bool()>& must_stop) override {
        for (const double rate : asked()) {
            const std::vector<RampRow> one = with_place({argument(), 0, 0}, [&] {
                return ramped_trips(point(), {rate}, at(), end().end, options_of(cycles_, must_stop));
            });
            if (one.empty())
                return;
            rows_.push_back(one.front());
            note(rows_.size());
        }
    }

    double cycles_;
    std::vector<RampRow> rows_;
};

class WaveTrips : public DisturbedTrips {
public:
    WaveTrips(const HeldLossPoint& from, const std::vector<std::string>& amplitudes, const std::string& at,
              double cycles, double period)
        : DisturbedTrips(from, amplitudes, "wave", at), cycles_(cycles), period_(period) {}

    Table table() const override { return wave_table(point(), asked(), trips_); }
    Figure figure() const override { return wave_figure(point(), origin_.value(), asked(), trips_, end().words); }
    std::vector<std::string> unfinished() const override { return unfinished_trips(asked(), trips_); }
    std::size_t rows() const override { return trips_.size(); }

private:
    void compute_until(const std::function<bool()>& must_stop) override {
        origin_ = origin();
        for (const double amplitude : asked()) {
            const std::vector<TripTime> one = with_place({argument(), 0, 0}, [&] {
                return swung_trips(point(), *origin_, {amplitude}, period_ * origin_->cycle, end().end,
                                   options_of(cycles_, must_stop));
            });
            if (one.empty())
                return;
            trips_.push_back(one.front());
            note(trips_.size());
        }
    }

    double cycles_, period_;
    std::optional<TripOrigin> origin_;
    std::vector<TripTime> trips_;
};

class NoiseTrips : public DisturbedTrips {
public:
    NoiseTrips(const HeldLossPoint& from, const std::vector<std::string>& levels, const std::string& at,
               const NoiseSettings& settings)
        : DisturbedTrips(from, levels, "noise", at), settings_(settings) {}

    Table table() const override { return noise_table(point(), asked(), all_); }
    Figure figure() const override { return noise_figure(point(), asked(), all_, settings_); }
    std::vector<std::string> unfinished() const override { return unfinished_trips(asked(), all_); }
    std::size_t rows() const override { return all_.size(); }

private:
    std::size_t steps() const override { return asked().size() * settings_.motions; }
    void compute_until(const std::function<bool()>& must_stop) override {
        NoiseSettings settings = settings_;
        settings.interrupted = must_stop;
        const TripOrigin rest = origin();
        all_ = with_place({argument(), 0, 0}, [&] {
            return noisy_trips(
                point(), rest, asked(), end().end, settings,
                [&](std::size_t level, std::size_t motions) { note(level * settings.motions + motions); });
        });
    }

    NoiseSettings settings_;
    std::vector<NoisyTrips> all_;
};

py::dict facts_of_point(const HeldLossPoint& self) {
    const LossPoint& point = self.point();
    py::dict object;
    object["parameter"] = point.name;
    object["unit"] = point.unit;
    object["kind"] = point.kind();
    object["value"] = point.value;
    object["side"] = point.side;
    object["cycle"] = point.cycle;
    object["end"] = self.end().words;
    object["end_given"] = self.end().given;
    object["speed"] = point.fold ? py::object(py::none()) : py::float_(level_until(point, self.end().end));
    object["coefficient"] = point.fold ? py::object(py::float_(point.fold->coefficient)) : py::none();
    object["rate"] = point.fold ? py::object(py::float_(point.fold->rate)) : py::none();
    return object;
}

} // namespace

void bind_trips(py::module_& module) {
    py::class_<HeldLossPoint>(module, "LossPoint")
        .def(py::init<const ResultFile&, const std::string&, const std::string&, const std::optional<std::string>&,
                      std::optional<double>>(),
             py::arg("file"), py::arg("point"), py::kw_only(), py::arg("parameter"), py::arg("until"),
             py::arg("greatest_speed"))
        .def("object", [](const HeldLossPoint& self) { return facts_of_point(self); });
    py::class_<Trips>(module, "Trips")
        .def("compute", &Trips::compute)
        .def("table", [](const Trips& self) { return columns_of(self.table()); })
        .def("figure", [](const Trips& self) { return object_of(self.figure()); })
        .def("unfinished", &Trips::unfinished)
        .def_property_readonly("rows", &Trips::rows)
        .def_property_readonly("wanted", &Trips::wanted);
    py::class_<TripsBeyond, Trips>(module, "TripsBeyond")
        .def(py::init<const HeldLossPoint&, const HeldLossPoint*, const std::optional<std::vector<std::string>>&,
                      double, const std::vector<std::pair<std::string, std::string>>&>(),
             py::arg("point"), py::kw_only(), py::arg("beside"), py::arg("overshoots"), py::arg("cycles"),
             py::arg("disturbance"));
    py::class_<RampTrips, Trips>(module, "RampTrips")
        .def(py::init<const HeldLossPoint&, const std::vector<std::string>&, const std::optional<std::string>&,
                      double>(),
             py::arg("point"), py::kw_only(), py::arg("rates"), py::arg("at"), py::arg("cycles"));
    py::class_<WaveTrips, Trips>(module, "WaveTrips")
        .def(py::init<const HeldLossPoint&, const std::vector<std::string>&, const std::string&, double, double>(),
             py::arg("point"), py::kw_only(), py::arg("amplitudes"), py::arg("at"), py::arg("cycles"),
             py::arg("period"));
    py::class_<NoiseTrips, Trips>(module, "NoiseTrips")
        .def(py::init([](const HeldLossPoint& point, const std::vector<std::string>& levels, const std::string& at,
                         std::size_t cycles, double memory, std::size_t motions, std::uint64_t seed, int threads) {
                 NoiseSettings settings;
                 settings.cycles = cycles;
                 settings.memory = memory;
                 settings.motions = motions;
                 settings.seed = seed;
                 settings.jobs = threads;
                 return std::make_unique<NoiseTrips>(point, levels, at, settings);
             }),
             py::arg("point"), py::kw_only(), py::arg("levels"), py::arg("at"), py::arg("cycles"), py::arg("memory"),
             py::arg("motions"), py::arg("seed"), py::arg("threads"));
}

} // namespace graze::python
