#include "graze/acquire/acquisition.hpp"
#include "graze/base/input_error.hpp"
#include "graze/model/named_value.hpp"
#include "graze/results/name_advice.hpp"
#include "instrument/bench_lines.hpp"
#include "instrument/bench_service.hpp"
#include "python/attended.hpp"
#include "python/noted.hpp"
#include "python/tables.hpp"
#include "python/words.hpp"

#include <algorithm>
#include <atomic>
#include <memory>
#include <optional>
#include <thread>
#include <unistd.h>
#include <variant>

namespace graze::python {

namespace {

using ChannelValues = std::vector<std::pair<std::string, std::variant<double, std::string>>>;

void set_each(BenchSettings& settings, const py::dict& words, const char* name, double BenchChannel::*property) {
    ChannelValues values;
    read_word(words, name, values);
    std::vector<std::string> names;
    for (const BenchChannel& channel : settings.channels)
        names.push_back(channel.value.name);
    for (const auto& [channel, value] : values) {
        const auto found = std::ranges::find(names, channel);
        if (found == names.end())
            throw InputError(Place{name, 0, 0}, "there is no channel '" + channel + "'",
                             name_advice(channel, names, ""));
        settings.channels[static_cast<std::size_t>(found - names.begin())].*property =
            std::holds_alternative<double>(value)
                ? std::get<double>(value)
                : value_of_text(settings.model, std::get<std::string>(value), Place{name, 0, 0});
    }
}

BenchSettings bench_settings_from(const Model& model, const py::dict& words) {
    BenchSettings settings;
    settings.model = model;
    std::string amplitude = "V0", frequency = "f", offset;
    read_word(words, "amplitude", amplitude);
    read_word(words, "frequency", frequency);
    read_word(words, "offset", offset);
    settings.amplitude = driven_input(model, amplitude, "amplitude");
    settings.frequency = driven_input(model, frequency, "frequency");
    if (!offset.empty())
        settings.offset = driven_input(model, offset, "offset");
    read_word(words, "time_unit", settings.time_unit);
    std::vector<std::string> channels = usual_channels(model);
    read_word(words, "channels", channels);
    for (const std::string& text : channels)
        settings.channels.push_back(bench_channel(model, text, "channels"));
    set_each(settings, words, "noise", &BenchChannel::noise);
    set_each(settings, words, "bias", &BenchChannel::offset);
    set_each(settings, words, "drift", &BenchChannel::drift);
    set_each(settings, words, "range", &BenchChannel::range);
    read_word(words, "bits", settings.bits);
    read_word(words, "anti_alias", settings.anti_alias);
    read_word(words, "seed", settings.seed);
    return settings;
}

GeneratorSettings generator_from(const py::dict& words) {
    GeneratorSettings generator;
    read_word(words, "clip", generator.clip);
    read_word(words, "left_as", generator.left_as);
    return generator;
}

/// A virtual bench, which one caller at a time may use.
class HeldBench {
public:
    HeldBench(const Model& model, const py::dict& words)
        : bench_(bench_settings_from(model, words), generator_from(words)) {}

    /// The bench for one caller, as long as the result exists. @throws OrderError while another one uses it
    class Use {
    public:
        explicit Use(HeldBench& held) : held_(&held) {
            if (held.used_.exchange(true))
                throw OrderError("the bench is in use", "wait until its service, or what else uses it, has ended");
        }
        ~Use() { held_->used_ = false; }
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;
        ScpiBench& operator*() const { return held_->bench_; }
        ScpiBench* operator->() const { return &held_->bench_; }

    private:
        HeldBench* held_;
    };

private:
    std::atomic<bool> used_ = false;
    ScpiBench bench_;
};

py::tuple sampled(HeldBench& held, std::size_t count) {
    const HeldBench::Use bench(held);
    Samples samples;
    attended([&](const MustStop& must_stop) {
        constexpr std::size_t part = 8192;
        samples.clear(bench->header().channels.size());
        Samples more;
        for (std::size_t taken = 0; taken < count && !must_stop(); taken += part) {
            bench->sample(std::min(part, count - taken), more);
            samples.append(more);
            if (!bench->ended().empty())
                break;
        }
    });
    py::list columns;
    for (std::vector<double>& values : samples.values)
        columns.append(array_of(std::move(values)));
    return py::make_tuple(array_of(std::move(samples.times)), columns);
}

void pass(HeldBench& held, double seconds) {
    const HeldBench::Use bench(held);
    attended([&](const MustStop& must_stop) {
        constexpr double part = 1; // seconds
        for (double passed = 0; passed < seconds && !must_stop(); passed += part)
            bench->pass(std::min(part, seconds - passed));
    });
}

void drive(HeldBench& held, double frequency, double amplitude, double offset, const std::string& shape) {
    GeneratorOutput output{frequency, amplitude, offset};
    const std::vector<std::string> names{"sine", "square", "triangle", "ramp", "dc"};
    const auto known = std::ranges::find(names, shape);
    if (known == names.end())
        throw InputError("there is no shape '" + shape + "'", name_advice(shape, names, ""));
    output.shape = static_cast<WaveShape>(known - names.begin());
    HeldBench::Use(held)->drive(output);
}

/// The connections of a bench, served by a thread of their own.
class HeldService {
public:
    HeldService(std::shared_ptr<HeldBench> bench, const ServiceSettings& settings)
        : state_(std::make_unique<State>(std::move(bench), settings)) {}
    HeldService(const HeldService&) = delete;
    HeldService& operator=(const HeldService&) = delete;
    ~HeldService() {
        if (getpid() != owner_) {
            static_cast<void>(state_.release()); // a forked process has neither the thread nor the connections
            return;
        }
        const Unlocked unlocked;
        state_->stop = true;
        state_.reset();
    }
    std::uint16_t tcp_port() const { return state_->service.tcp_port(); }

private:
    struct State {
        State(std::shared_ptr<HeldBench> of_bench, const ServiceSettings& settings)
            : bench(std::move(of_bench)), use(*bench), service(*use, settings), thread([this] { serve(); }) {}
        void serve() {
            const RunningWork running;
            try {
                service.run([this] { return stop.load() || process_is_ending(); });
            } catch (const std::exception&) { // clients see that the connection is closed
            }
        }
        std::shared_ptr<HeldBench> bench;
        HeldBench::Use use;
        BenchService service;
        std::atomic<bool> stop = false;
        std::jthread thread; ///< the last member, since it uses the others
    };
    std::unique_ptr<State> state_;
    pid_t owner_ = getpid();
};

ServiceSettings service_from(const py::dict& words) {
    ServiceSettings settings;
    read_word(words, "port", settings.port);
    read_word(words, "tcp", settings.tcp);
    read_word(words, "speed", settings.speed);
    read_word(words, "on_demand", settings.on_demand);
    read_word(words, "drop", settings.drop);
    read_word(words, "delay", settings.delay);
    read_word(words, "break_after", settings.lines);
    read_word(words, "break_for", settings.broken);
    read_word(words, "break_samples", settings.rows);
    read_word(words, "seed", settings.seed);
    return settings;
}

py::list levels_of(const Experiment& experiment) {
    py::list list;
    for (const Level& level : experiment.levels)
        list.append(py::make_tuple(level.number, level.frequency, level.amplitude, level.direction,
                                   experiment.record_name(level)));
    return list;
}

/// An acquisition, whose report remains when it was interrupted.
class HeldAcquisition {
public:
    HeldAcquisition(const Experiment& experiment, const std::string& folder)
        : experiment_(experiment), folder_(folder) {}

    /// @param bench in place of instruments; null: there are instruments
    /// @param watch file to which the letter a is written before the first setting; negative: none
    void run(const std::shared_ptr<HeldBench>& bench, int watch, const py::object& told) {
        std::optional<HeldBench::Use> use;
        if (bench)
            use.emplace(*bench);
        attended([&](const MustStop& must_stop) { run_unlocked(use ? &**use : nullptr, watch, must_stop); },
                 telling(told, [this] { return progress(); }));
    }
    py::dict report() const {
        py::dict object;
        object["ending"] = std::string(name_of(report_.ending));
        object["detail"] = report_.detail;
        object["remedy"] = report_.ending == AcquisitionEnding::complete ? "" : remedy_of(report_.ending);
        object["before"] = report_.before;
        object["recorded"] = report_.recorded;
        object["unsettled"] = report_.unsettled;
        object["safe"] = report_.safe;
        object["unsafe_because"] = report_.unsafe_because;
        object["off"] = report_.off;
        py::list entries;
        for (const RecordEntry& entry : entries_)
            entries.append(py::make_tuple(entry.level.number, experiment_.record_name(entry.level),
                                          entry.level.frequency, entry.level.amplitude, entry.level.direction,
                                          entry.told, entry.settled, entry.settling, entry.samples));
        object["entries"] = entries;
        return object;
    }

private:
    void run_unlocked(ScpiBench* bench, int watch, const MustStop& must_stop) {
        report_ = {};
        report_.ending = AcquisitionEnding::interrupted;
        RecordFolder folder(folder_, experiment_);
        AcquisitionOptions options;
        options.interrupted = must_stop;
        options.progress = [this](const AcquisitionProgress& progress) { progress_.note(progress); };
        options.begun = [watch] {
            if (watch >= 0 && write(watch, "a", 1) != 1)
                throw InstrumentError(AcquisitionEnding::interrupted, "the process that watches this one has ended");
        };
        try {
            const std::unique_ptr<InstrumentLine> generator =
                bench ? std::make_unique<BenchGeneratorLine>(*bench) : open_generator_line(experiment_.serial);
            std::shared_ptr<InstrumentLine> line;
            if (bench)
                line = std::make_shared<BenchSampleLine>(*bench);
            else
                line = open_sample_line(experiment_, Place{"device", 0, 0});
            TextSampleDevice device(line, experiment_.sample_timeout, must_stop, experiment_.sample_patience);
            report_ = acquire(experiment_, *generator, device, folder, options);
        } catch (const InstrumentError& error) { // nothing has been sent to the generator yet
            report_.ending = error.ending();
            report_.detail = error.problem();
            report_.before = folder.entries().size();
        }
        entries_.clear();
        for (const auto& [number, entry] : folder.entries())
            entries_.push_back(entry);
    }
    py::dict progress() const {
        const AcquisitionProgress now = progress_.now();
        py::dict object;
        object["stage"] = std::string(name_of(now.stage));
        object["number"] = now.level.number;
        object["levels"] = now.levels;
        object["recorded"] = now.recorded;
        object["frequency"] = now.level.frequency;
        object["amplitude"] = now.level.amplitude;
        object["direction"] = now.level.direction;
        object["time"] = now.time;
        return object;
    }

    Experiment experiment_;
    std::string folder_;
    AcquisitionReport report_;
    std::vector<RecordEntry> entries_;
    Noted<AcquisitionProgress> progress_;
};

/// Brings the generator of an experiment to its safe amplitude. @return why that failed; empty: it is safe
std::string made_safe(const Experiment& experiment) {
    SafeOutput output = make_safe(experiment);
    if (output.safe)
        return "";
    if (output.off)
        output.problem += "; its output is switched off, as it tells itself";
    return output.problem.empty() ? "it does not answer" : output.problem;
}

} // namespace

void bind_experiments(py::module_& module) {
    py::class_<HeldBench, std::shared_ptr<HeldBench>>(module, "Bench")
        .def(py::init([](const HeldModel& model, const py::dict& words) {
                 return std::make_shared<HeldBench>(model.model, words);
             }),
             py::arg("model"), py::arg("words"))
        .def_property_readonly("channels",
                               [](HeldBench& self) {
                                   py::list list;
                                   for (const Channel& one : HeldBench::Use(self)->header().channels)
                                       list.append(py::make_tuple(one.name, one.unit));
                                   return list;
                               })
        .def("drive", &drive, py::arg("frequency"), py::arg("amplitude"), py::arg("offset"), py::arg("shape"))
        .def("command", [](HeldBench& self, const std::string& line) { return HeldBench::Use(self)->command(line); })
        .def("output",
             [](HeldBench& self) {
                 const HeldBench::Use bench(self);
                 const GeneratorOutput& output = bench->generator().output();
                 return py::make_tuple(output.frequency, output.amplitude, output.offset);
             })
        .def_property(
            "rate", [](HeldBench& self) { return HeldBench::Use(self)->rate(); },
            [](HeldBench& self, double rate) { HeldBench::Use(self)->set_rate(rate); })
        .def_property_readonly("time", [](HeldBench& self) { return HeldBench::Use(self)->time(); })
        .def_property_readonly("ended", [](HeldBench& self) { return HeldBench::Use(self)->ended(); })
        .def("sample", &sampled, py::arg("count"))
        .def("pass_", &pass, py::arg("seconds"))
        .def("mark", [](HeldBench& self, std::uint64_t number) { HeldBench::Use(self)->mark(number); })
        .def("return_to",
             [](HeldBench& self, std::uint64_t number) { return HeldBench::Use(self)->return_to(number); });
    py::class_<HeldService>(module, "BenchService")
        .def(py::init([](const std::shared_ptr<HeldBench>& bench, const py::dict& words) {
                 return std::make_unique<HeldService>(bench, service_from(words));
             }),
             py::arg("bench"), py::arg("words"))
        .def_property_readonly("tcp_port", &HeldService::tcp_port);
    py::class_<Experiment, std::shared_ptr<Experiment>>(module, "Experiment")
        .def_static(
            "parsed",
            [](const std::string& text, const std::string& file) {
                return std::make_shared<Experiment>(parse_experiment(text, file));
            },
            py::arg("text"), py::arg("file"))
        .def_readonly("name", &Experiment::name)
        .def_readonly("text", &Experiment::text)
        .def_readonly("safe", &Experiment::safe)
        .def_readonly("rate", &Experiment::rate)
        .def_readonly("samples", &Experiment::samples)
        .def_property(
            "port", [](const Experiment& self) { return self.serial.port; },
            [](Experiment& self, const std::string& port) {
                generator_address(port, Place{"port", 0, 0});
                self.serial.port = port;
            })
        .def_property(
            "device", [](const Experiment& self) { return self.device; },
            [](Experiment& self, const std::string& device) {
                device_address(device, Place{"device", 0, 0});
                self.device = device;
            })
        .def_property_readonly("levels", &levels_of)
        .def("make_safe", &made_safe, py::call_guard<Unlocked>());
    py::class_<HeldAcquisition>(module, "Acquisition")
        .def(py::init<const Experiment&, const std::string&>(), py::arg("experiment"), py::arg("folder"))
        .def("run", &HeldAcquisition::run, py::arg("bench"), py::arg("watch"), py::arg("told"))
        .def("report", &HeldAcquisition::report);
}

} // namespace graze::python
