#include "graze/acquire/acquisition.hpp"
#include "graze/base/input_error.hpp"
#include "program/commands.hpp"
#include "program/interrupt.hpp"
#include "program/live_picture.hpp"
#include "program/status_line.hpp"
#include "program/watchdog.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

namespace graze {

namespace {

/// Reads the experiment file; --port and --device replace its addresses.
/// @throws InputError when an address is missing, unless nothing is to be sent (--dry-run)
Experiment asked_experiment(const AcquireArguments& arguments) {
    Experiment experiment = read_experiment(arguments.experiment);
    if (!arguments.port.empty()) {
        generator_address(arguments.port, Place{"--port", 0, 0});
        experiment.serial.port = arguments.port;
    }
    if (!arguments.device.empty()) {
        device_address(arguments.device, Place{"--device", 0, 0});
        experiment.device = arguments.device;
    }
    if (arguments.dry_run)
        return experiment;
    if (experiment.serial.port.empty())
        throw InputError(Place{arguments.experiment, 0, 0}, "nothing says where the generator is",
                         "give port = \"/dev/ttyUSB0\" under [generator], or --port");
    if (experiment.device.empty())
        throw InputError(Place{arguments.experiment, 0, 0}, "nothing says where samples come from",
                         "give device = \"tcp:HOST:PORT\" under [samples], or --device");
    return experiment;
}

const char* direction_name(int direction) {
    return direction > 0 ? "up" : direction < 0 ? "down" : "";
}

void print_levels(const Experiment& experiment, const Console& console) {
    Table table({{"number", ""}, {"frequency", "Hz"}, {"amplitude", "V"}, {"direction", ""}, {"file", ""}});
    for (const Level& level : experiment.levels) {
        table.add(level.number, level.frequency, level.amplitude, direction_name(level.direction),
                  experiment.record_name(level));
    }
    deliver(table, {}, {}, console);
}

/// Shows an acquisition while it runs: a line of progress and, with --live, a picture of the records.
class AcquisitionDisplay {
public:
    AcquisitionDisplay(const RecordFolder& folder, const AcquireArguments& arguments, const Console& console)
        : folder_(folder), console_(console), line_(console, arguments.progress || console.terminal) {
        if (arguments.live.empty())
            return;
        picture_.emplace(arguments);
        for (const auto& [number, entry] : folder.entries())
            add(entry);
    }

    void progress(const AcquisitionProgress& progress) {
        if (!line_.is_due())
            return;
        std::string text = fmt::format("record {} of {}: {} Hz, {} V {}, {}", progress.level.number, progress.levels,
                                       progress.level.frequency, progress.level.amplitude,
                                       direction_name(progress.level.direction), name_of(progress.stage));
        if (progress.time > 0)
            text += fmt::format(" {:.0f} s", progress.time);
        if (recorded_ > 0)
            text += fmt::format(", {:.0f} s left", line_.elapsed() / static_cast<double>(recorded_) *
                                                       static_cast<double>(progress.levels - progress.recorded));
        line_.show(text);
    }
    void record(const RecordEntry& entry) {
        ++recorded_;
        add(entry);
        draw(false);
    }
    void draw(bool now) {
        attempt([&] { picture_->draw(now); });
    }

private:
    void add(const RecordEntry& entry) {
        attempt([&] { picture_->add(folder_.path_of(entry.level), entry.level.amplitude, entry.level.direction); });
    }
    /// Does work for the picture. If it fails, drawing ends with a warning and the experiment continues.
    template <class Work>
    void attempt(const Work& work) {
        if (!picture_)
            return;
        try {
            work();
        } catch (const InputError& error) {
            console_.err << "graze: warning: there is no picture any more: " << error.what() << '\n';
            picture_.reset();
        }
    }

    const RecordFolder& folder_;
    const Console& console_;
    StatusLine line_;
    std::optional<LivePicture> picture_;
    std::size_t recorded_ = 0;
};

AcquisitionReport run_experiment(const Experiment& experiment, RecordFolder& folder, AcquisitionDisplay& display) {
    Watchdog watchdog(experiment, folder);
    AcquisitionOptions options;
    options.interrupted = [] { return InterruptGuard::requested(); };
    options.progress = [&](const AcquisitionProgress& progress) { display.progress(progress); };
    options.begun = [&] { watchdog.arm(); };
    options.recorded = [&](const RecordEntry& entry) { display.record(entry); };
    AcquisitionReport report;
    try {
        const auto generator = open_generator_line(experiment.serial);
        TextSampleDevice device(open_sample_line(experiment, Place{experiment.file, 0, 0}), experiment.sample_timeout,
                                options.interrupted, experiment.sample_patience);
        report = acquire(experiment, *generator, device, folder, options);
    } catch (const InstrumentError& error) { // nothing has been sent to the generator yet
        report.ending = error.ending();
        report.detail = error.problem();
        report.before = folder.entries().size();
    } catch (...) {
        watchdog.disarm();
        throw;
    }
    watchdog.disarm();
    return report;
}

int tell_acquire(const AcquisitionReport& report, const Experiment& experiment, const std::string& folder,
                 const Console& console) {
    console.out << fmt::format("{}: {} of {} records\n", folder, report.before + report.recorded,
                               experiment.levels.size());
    if (report.unsettled > 0)
        console.err << fmt::format(
            "graze: warning: at {} levels sections did not repeat within {} s; see manifest.txt\n", report.unsettled,
            experiment.settling.most);
    if (report.ending != AcquisitionEnding::complete)
        console.err << fmt::format("graze: {}{}; {}\n",
                                   report.ending == AcquisitionEnding::interrupted
                                       ? std::string()
                                       : fmt::format("{}: ", name_of(report.ending)),
                                   report.detail, remedy_of(report.ending));
    if (!report.safe) {
        console.err << fmt::format("graze: the generator could not be brought to its safe amplitude, {} V ({}): {}\n",
                                   experiment.safe, report.unsafe_because,
                                   report.off ? "its output is switched off, as it tells itself"
                                              : "switch it off by hand");
        return exit_irregular;
    }
    if (report.ending == AcquisitionEnding::interrupted && InterruptGuard::requested())
        return InterruptGuard::exit_code();
    return report.ending == AcquisitionEnding::complete ? exit_success : exit_irregular;
}

} // namespace

int acquire_command(const AcquireArguments& arguments, const Console& console) {
    const Experiment experiment = asked_experiment(arguments);
    if (arguments.dry_run) {
        print_levels(experiment, console);
        return exit_success;
    }
    const InterruptGuard guard;
    const std::string folder = arguments.folder.empty() ? experiment.name : arguments.folder;
    RecordFolder records(folder, experiment);
    AcquisitionReport report;
    {
        AcquisitionDisplay display(records, arguments, console);
        report = run_experiment(experiment, records, display);
        display.draw(true);
    }
    return tell_acquire(report, experiment, folder, console);
}

} // namespace graze
