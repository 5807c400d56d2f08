#include "graze/acquire/acquisition.hpp"

#include "acquire/instrument_failure.hpp"
#include "base/enumerator_name.hpp"
#include "graze/acquire/serial_line.hpp"
#include "graze/acquire/settling.hpp"

#include <algorithm>
#include <cmath>
#include <exception>

namespace graze {

namespace {

/// One execution of an experiment.
class ExperimentRun {
public:
    ExperimentRun(const Experiment& experiment, InstrumentLine& line, SampleDevice& device, RecordFolder& folder,
                  const AcquisitionOptions& options)
        : experiment_(experiment), device_(device), folder_(folder), options_(options),
          generator_(borrowed(line), generator_options(experiment, options)) {}

    AcquisitionReport run() {
        report_.before = folder_.entries().size();
        std::exception_ptr failure;
        try {
            record_all();
        } catch (const InstrumentError& error) {
            report_.ending = error.ending();
            report_.detail = error.problem();
        } catch (const std::exception& error) { // rethrown when the output is safe
            failure = std::current_exception();
            report_.detail = error.what();
        } catch (...) {
            failure = std::current_exception();
            report_.detail = "a callback has thrown what is no std::exception";
        }
        if (begun_)
            report_.safe = generator_.make_safe(experiment_.safe, report_.unsafe_because);
        report_.off = !report_.safe && generator_.is_switched_off();
        if (failure && report_.safe)
            std::rethrow_exception(failure);
        if (failure) // an unsafe output is worse than its cause, and both must be reported
            report_.ending = AcquisitionEnding::interrupted;
        return report_;
    }

private:
    static GeneratorOptions generator_options(const Experiment& experiment, const AcquisitionOptions& options) {
        GeneratorOptions result = experiment.generator;
        result.interrupted = options.interrupted;
        return result;
    }

    void record_all() {
        const auto missing = std::find_if(experiment_.levels.begin(), experiment_.levels.end(),
                                          [&](const Level& level) { return !folder_.has(level); });
        if (missing == experiment_.levels.end())
            return;
        choose_channels();
        device_.set_rate(experiment_.rate);
        generator_.identify();
        begun_ = true;
        if (options_.begun)
            options_.begun();
        generator_.begin(missing->frequency, experiment_.safe, experiment_.offset);
        const auto first = static_cast<std::size_t>(missing - experiment_.levels.begin());
        const bool back = device_.return_to(mark_of(missing->number));
        if (!back && first > 0)
            walk_to(first);
        if (!back)
            device_.mark(mark_of(missing->number));
        for (std::size_t i = first; i < experiment_.levels.size(); ++i) {
            // A missing record between existing ones is recorded again on the way.
            if (!folder_.has(experiment_.levels[i]))
                record(experiment_.levels[i]);
            else
                pass(experiment_.levels[i]);
        }
    }

    /// Number of a mark, distinct for this experiment and folder, since the device may have served others.
    std::uint64_t mark_of(std::size_t number) const { return folder_.identity() + number; }

    void choose_channels() {
        const RecordHeader& all = device_.header();
        header_.time = all.time;
        chosen_ = all.chosen_channels(experiment_.channels, "samples.channels");
        for (const std::size_t c : chosen_)
            header_.channels.push_back(all.channels[c]);
        const SettlingOptions& settling = experiment_.settling;
        if (!settling.reference.empty())
            all.channel(settling.reference, "settle.reference");
        for (const SettlingOptions::Tolerance& tolerance : settling.tolerances)
            all.channel(tolerance.channel, "settle.tolerance");
    }

    void tell(AcquisitionStage stage, const Level& level, double time) const {
        if (options_.progress)
            options_.progress({stage, level, experiment_.levels.size(), folder_.entries().size(), time});
    }

    double set(const Level& level) {
        tell(AcquisitionStage::setting, level, 0);
        if (frequency_ != level.frequency)
            generator_.set_frequency(level.frequency);
        frequency_ = level.frequency;
        return generator_.set_amplitude(level.amplitude);
    }

    Settled wait(const Level& level, AcquisitionStage stage) {
        return settle(device_, experiment_.settling, experiment_.rate, [&](double time) { tell(stage, level, time); });
    }

    void skip(const Level& level, std::size_t count) {
        Samples part;
        if (count == 0)
            return;
        device_.begin(count);
        double taken = 0;
        while (device_.read(part)) {
            taken += static_cast<double>(part.rows());
            tell(AcquisitionStage::walking, level, taken / experiment_.rate);
        }
    }

    /// Passes through a level as if it were recorded.
    void pass(const Level& level) {
        set(level);
        if (experiment_.walk) {
            skip(level, static_cast<std::size_t>(std::llround(*experiment_.walk * experiment_.rate)));
        } else {
            wait(level, AcquisitionStage::walking);
            skip(level, experiment_.samples);
        }
        device_.mark(mark_of(level.number + 1));
    }

    /// Repeats all earlier levels; with a walking time, only those of the present leg.
    void walk_to(std::size_t level) {
        for (std::size_t i = 0; i < level; ++i)
            if (!experiment_.walk ||
                (*experiment_.walk > 0 && experiment_.levels[i].leg == experiment_.levels[level].leg))
                pass(experiment_.levels[i]);
    }

    void record(const Level& level) {
        RecordEntry entry;
        entry.level = level;
        entry.told = set(level);
        const Settled settled = wait(level, AcquisitionStage::settling);
        entry.settled = settled.settled;
        entry.settling = settled.time;
        const std::unique_ptr<RecordWriter> writer = folder_.begin(level, header_);
        Samples part, kept;
        device_.begin(experiment_.samples);
        while (device_.read(part)) {
            kept.times = part.times;
            kept.values.resize(chosen_.size());
            for (std::size_t i = 0; i < chosen_.size(); ++i)
                kept.values[i] = part.values[chosen_[i]];
            writer->write(kept);
            entry.samples += part.rows();
            tell(AcquisitionStage::recording, level, part.times.back());
        }
        writer->close();
        require_unchanged(level);
        device_.mark(mark_of(level.number + 1)); // before the commit: whoever resumes after it finds the mark
        folder_.commit(entry);
        ++report_.recorded;
        report_.unsettled += entry.settled ? 0 : 1;
        if (options_.recorded)
            options_.recorded(folder_.entries().at(level.number));
    }

    /// Checks that the amplitude was not changed during the record.
    void require_unchanged(const Level& level) {
        double told = 0;
        for (int attempt = 1;; ++attempt) { // a character may have been lost
            told = generator_.amplitude();
            if (std::abs(told - level.amplitude) <= experiment_.generator.tolerance * level.amplitude)
                return;
            if (attempt >= experiment_.generator.attempts)
                break;
        }
        fail(AcquisitionEnding::clipped,
             "the generator gives an amplitude of {} V, which was {} V when the record began; the record is not kept",
             told, level.amplitude);
    }

    const Experiment& experiment_;
    SampleDevice& device_;
    RecordFolder& folder_;
    const AcquisitionOptions& options_;
    GeneratorClient generator_;
    AcquisitionReport report_;
    RecordHeader header_;
    std::vector<std::size_t> chosen_;
    double frequency_ = 0;
    bool begun_ = false;
};

} // namespace

AcquisitionReport acquire(const Experiment& experiment, InstrumentLine& generator, SampleDevice& device,
                          RecordFolder& folder, const AcquisitionOptions& options) {
    return ExperimentRun(experiment, generator, device, folder, options).run();
}

std::string_view name_of(AcquisitionStage stage) {
    constexpr std::string_view names[] = {"walking", "setting", "settling", "recording"};
    return enumerator_name<AcquisitionStage>(names, stage, "recording");
}

SafeOutput make_safe(const Experiment& experiment) {
    SafeOutput output;
    try {
        std::shared_ptr<InstrumentLine> line = open_generator_line(experiment.serial);
        GeneratorOptions options = experiment.generator;
        options.interrupted = nullptr;
        GeneratorClient client(std::move(line), options);
        output.safe = client.make_safe(experiment.safe, output.problem);
        output.off = !output.safe && client.is_switched_off();
    } catch (const std::exception& error) {
        output.problem = error.what();
    }
    return output;
}

} // namespace graze
