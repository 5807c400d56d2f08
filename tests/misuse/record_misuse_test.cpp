// Wrong uses of records, their processing, and experiments.

#include "misuse/wrong_use.hpp"

#include "base/temporary_folder.hpp"
#include "graze/acquire/instrument_line.hpp"
#include "graze/acquire/settling.hpp"
#include "graze/identify/coupling.hpp"
#include "graze/identify/decrement.hpp"
#include "graze/identify/estimate.hpp"
#include "graze/identify/impedance.hpp"
#include "graze/identify/residual_test.hpp"
#include "graze/identify/restitution.hpp"
#include "graze/record/calibrated.hpp"
#include "graze/record/derivative.hpp"
#include "graze/record/extremes.hpp"
#include "graze/record/harmonic.hpp"
#include "graze/record/impacts.hpp"
#include "graze/record/interpolate.hpp"
#include "graze/record/low_pass.hpp"
#include "graze/record/period.hpp"
#include "graze/record/processed_record.hpp"
#include "graze/record/record_file.hpp"
#include "graze/record/record_writer.hpp"
#include "graze/record/section.hpp"
#include "graze/record/spectrum.hpp"

#include <cmath>

namespace graze::record_misuse_test {

using namespace graze::testing;

RecordHeader header() {
    return {{"t", "s"}, {{"x", "mm"}, {"v", "mm/s"}}};
}

Samples wave(int rows = 400) {
    Samples samples;
    samples.values.resize(2);
    for (int i = 0; i < rows; ++i) {
        samples.times.push_back(i * 0.05);
        samples.values[0].push_back(std::sin(i * 0.05));
        samples.values[1].push_back(std::cos(i * 0.05));
    }
    return samples;
}

Period period() {
    StoredSamples source(header(), wave());
    PeriodSplitter splitter(borrowed(source), {});
    Period one;
    splitter.next(one);
    return one;
}

void samples(WrongUses& wrong) {
    wrong("append_last", wrong_indices(401), [](std::size_t last) { Samples().append(wave(), 0, last); });
    wrong("append_reversed", [] { Samples().append(wave(), 5, 4); });
    wrong("append_other_channels", [] {
        Samples all = wave(), other = wave();
        other.values.pop_back();
        all.append(other);
    });
    wrong("append_ragged", [] {
        Samples other = wave();
        other.values[1].pop_back();
        Samples().append(other);
    });
    wrong("drop_front_too_many", [] { wave().drop_front(401); });
    wrong("drop_front_ragged", [] {
        Samples ragged = wave();
        ragged.values[1].clear();
        ragged.drop_front(5);
    });
    const auto stored =
        wrong.spoiled<Samples>([] { return wave(); }, {{"stored", [](Samples& s) { StoredSamples(header(), s); }}});
    stored("other_channels", [](Samples& s) { s.values.pop_back(); });
    stored("ragged", [](Samples& s) { s.values[0].pop_back(); });
    stored("times_fall", [](Samples& s) { s.times[3] = s.times[2]; });
    stored("time", not_finite(), [](Samples& s, double value) { s.times[3] = value; });
    stored("value", not_finite(), [](Samples& s, double value) { s.values[1][3] = value; });
    wrong("channel_unknown", [] { keep(header().channel("y", "me")); });
    wrong("channel_time", [] { keep(header().channel("t", "me")); });
    wrong("read_all_too_many", [] {
        StoredSamples source(header(), wave());
        read_all(source, 10);
    });
}

void writers(WrongUses& wrong) {
    for (const std::string ending : {"h5", "csv"}) {
        const auto writer = [&](const std::string& name, const std::function<void(RecordWriter&)>& use) {
            wrong("writer_" + ending + "_" + name, [use, ending](TemporaryFolder& folder) {
                RecordWriter writer(folder / ("r." + ending), header());
                use(writer);
            });
        };
        const auto written = wrong.spoiled<Samples>([] { return wave(); },
                                                    {{"writer_" + ending, [ending](Samples& s) {
                                                          const TemporaryFolder folder;
                                                          RecordWriter(folder / ("r." + ending), header()).write(s);
                                                      }}});
        written("other_channels", [](Samples& s) { s.values.pop_back(); });
        written("more_channels", [](Samples& s) { s.values.push_back(s.times); });
        written("ragged", [](Samples& s) { s.values[1].pop_back(); });
        written("time", not_finite(), [](Samples& s, double value) { s.times[1] = value; });
        written("value", not_finite(), [](Samples& s, double value) { s.values[0][1] = value; });
        writer("write_after_close", [](RecordWriter& w) {
            w.close();
            w.write(wave());
        });
        writer("close_twice", [](RecordWriter& w) {
            w.close();
            w.close();
        });
        wrong("writer_" + ending + "_no_folder", [ending] { RecordWriter("/nowhere/at/all/r." + ending, header()); });
        const auto headed = wrong.spoiled<RecordHeader>(header, {{"writer_" + ending, [ending](RecordHeader& h) {
                                                                      const TemporaryFolder folder;
                                                                      RecordWriter(folder / ("r." + ending), h);
                                                                  }}});
        headed("no_name", [](RecordHeader& h) { h.channels[0].name.clear(); });
        headed("name_twice", [](RecordHeader& h) { h.channels[1].name = h.channels[0].name; });
        wrong("open_missing_" + ending, [ending] { open_record("/nowhere/at/all/r." + ending); });
    }
    wrong("open_folder", [] { open_record("/"); });
    wrong("header_empty", [] { parse_record_header("", {}); });
    wrong("header_name_twice", [] { parse_record_header("t, x, x", {}); });
}

void stages(WrongUses& wrong) {
    using Source = std::shared_ptr<SampleSource>;
    const auto on_record = [&](const std::string& name, const std::function<void(const Source&)>& use) {
        wrong(name, [use] { use(std::make_shared<StoredSamples>(header(), wave())); });
    };
    wrong("calibrated_without_source", [] { Calibrated({}, {}); });
    wrong("low_pass_without_source", [] { LowPass({}, {.pass = 1}); });
    wrong("derivative_without_source", [] { WithDerivative({}, {}); });
    wrong("splitter_without_source", [] { PeriodSplitter({}, {}); });
    wrong("impacts_without_source", [] { ImpactFinder({}, {}); });
    wrong("processed_without_source", [] { ProcessedRecord(Source{}, {}); });
    for (const auto& [name, index] : wrong_indices(2)) {
        on_record("calibrated_channel_" + name,
                  [index = index](const Source& s) { Calibrated(s, {.calibrations = {{index}}}); });
        on_record("derivative_channel_" + name,
                  [index = index](const Source& s) { WithDerivative(s, {.channel = index, .name = {}}); });
        on_record("splitter_channel_" + name,
                  [index = index](const Source& s) { PeriodSplitter(s, {.reference = index}); });
        on_record("impacts_channel_" + name, [index = index](const Source& s) { ImpactFinder(s, {{}, index}); });
        on_record("impacts_displacement_" + name, [index = index](const Source& s) {
            ImpactFinder(s, {{}, 0, index});
        });
        on_record("spectrum_channel_" + name, [index = index](const Source& s) { averaged_spectrum(*s, index, 16); });
        wrong("extremes_channel_" + name, [index = index] { extremes(period(), index); });
        wrong("amplitude_channel_" + name, [index = index] { keep(amplitude(period(), index)); });
        wrong("image_channel_" + name, [index = index] { image_of(section(period(), 0), {.negated = {index}}); });
    }
    for (const auto& [name, value] : not_finite()) {
        on_record("calibrated_factor_" + name, [value = value](const Source& s) {
            Calibrated(s, {.calibrations = {{0, value}}});
        });
        on_record("splitter_level_" + name, [value = value](const Source& s) { PeriodSplitter(s, {.level = value}); });
        on_record("splitter_hysteresis_" + name,
                  [value = value](const Source& s) { PeriodSplitter(s, {.hysteresis = value}); });
        wrong("section_phase_" + name, [value = value] { section(period(), value); });
        wrong("image_shift_" + name,
              [value = value] { image_of(section(period(), 0), {.negated = {}, .shift = value}); });
        wrong("interpolate_" + name, [value = value] { keep(interpolate(wave(), value)); });
        wrong("harmonic_" + name, [value = value] { fit_harmonic(wave().times, wave().values[0], value); });
        wrong("spectrum_of_" + name, [value = value] { spectrum(std::vector<double>{1, value, 3, 4}, 1); });
    }
    on_record("calibrated_between_nothing", [](const Source& s) { Calibrated(s, {.begin = 1, .end = 0}); });
    on_record("calibrated_begin_nan", [](const Source& s) { Calibrated(s, {.begin = not_a_number}); });
    on_record("low_pass_of_nothing", [](const Source& s) { LowPass(s, {}); });
    on_record("low_pass_keeps_none", [](const Source& s) { LowPass(s, {.pass = 1, .every = 0}); });
    for (const auto& [name, value] : not_positive())
        if (value != 0) { // zero requests the default
            on_record("low_pass_pass_" + name, [value = value](const Source& s) { LowPass(s, {.pass = value}); });
            on_record("low_pass_stop_" + name,
                      [value = value](const Source& s) { LowPass(s, {.pass = 1, .stop = value}); });
            on_record("impacts_significance_" + name, [value = value](const Source& s) {
                ImpactFinder(s, {{}, 0, {}, value});
            });
        }
    on_record("impacts_window", [](const Source& s) { ImpactFinder(s, {{.window = 4}}); });
    on_record("derivative_width", [](const Source& s) { WithDerivative(s, {.half_width = 3, .name = {}}); });
    on_record("derivative_width_huge", [](const Source& s) {
        WithDerivative with(s, {.half_width = huge, .name = {}});
        Samples part;
        with.read(part);
    });
    on_record("spectrum_part", [](const Source& s) { averaged_spectrum(*s, 0, 7); });
    on_record("spectrum_part_huge", [](const Source& s) { averaged_spectrum(*s, 0, huge); });
    wrong("sampling_frequency_of_one", [] { keep(sampling_frequency(std::vector<double>{1})); });
    wrong("fit_period_of_one", [] { fit_period(std::vector<double>{1}); });
    wrong("fit_period_nan", [] { fit_period(std::vector<double>{1, not_a_number, 3}); });
}

void estimates(WrongUses& wrong) {
    wrong("residuals_of_other_readings",
          [] { test_residuals(std::vector<double>(20, 1), std::vector<double>(19, 1)); });
    wrong("combine_nothing", [] { combine({}); });
    wrong("decrement_of_nothing", [] { logarithmic_decrement({}); });
    wrong("oscillation_of_nothing", [] { damped_oscillation({}); });
    wrong("restitution_of_nothing", [] { restitution({}); });
    wrong("coupling_of_nothing", [] { coupling({}, {.gap = 1, .stiffness = 1}); });
    wrong("impedance_of_nothing", [] { impedance({}, {}, {}); });
    wrong("impedance_ragged", [] { impedance(wave().times, wave().values[0], std::vector<double>(3, 1)); });
    wrong("residuals", not_finite(), [](double value) { test_residuals(std::vector<double>{1, value, 3}); });
    wrong("restitution", not_finite(), [](double value) {
        restitution(std::vector<ImpactSpeeds>{{-1, 1}, {value, 1}, {-2, 2}});
    });
    wrong("coupling", not_finite(), [](double value) {
        coupling(std::vector<StaticLoad>{{1, 1}, {2, value}, {3, 3}, {4, 5}}, {.gap = 10, .stiffness = 1});
    });
    wrong("impedance", not_finite(), [](double value) {
        std::vector<double> voltage = wave().values[0];
        voltage[7] = value;
        impedance(wave().times, voltage, wave().values[1]);
    });
    wrong("coupling_gap", not_positive(), [](double value) {
        coupling(std::vector<StaticLoad>{{0.1, 1}, {0.2, 2}, {0.3, 3}}, {.gap = value, .stiffness = 1});
    });
    wrong("coupling_stiffness", not_positive(), [](double value) {
        coupling(std::vector<StaticLoad>{{0.1, 1}, {0.2, 2}, {0.3, 3}}, {.gap = 1, .stiffness = value});
    });
}

/// An instrument that never answers.
class SilentLine : public InstrumentLine {
public:
    void send(std::string_view /*line*/) override {}
    std::optional<std::string> receive(double /*wait*/) override { return std::nullopt; }
    void discard() override {}
    void reopen() override {}
};

void experiments(WrongUses& wrong) {
    wrong("awaited_line", not_finite(), [](double value) {
        SilentLine line;
        awaited_line(line, value, {}, "the generator");
    });
    wrong("watch_tolerance", not_finite(), [](double value) { RepeatWatch({0.1, value}, 1, 1); });
    wrong("watch_section", not_finite(), [](double value) { RepeatWatch({0.1, 0.1}, 1, 1).add({value, 1}); });
    wrong("watch_tolerance_negative", [] { RepeatWatch({-0.1}, 1, 1); });
    wrong("watch_section", wrong_lengths(2), [](std::size_t length) {
        RepeatWatch({0.1, 0.1}, 1, 1).add(std::vector<double>(length, 1));
    });
    wrong("watch_no_repeats", [] { RepeatWatch({0.1}, 0, 1); });
    wrong("watch_no_period", [] { RepeatWatch({0.1}, 1, 0); });
    wrong("watch_period_huge", [] { RepeatWatch({0.1}, 1, huge); });
}

TEST(WrongRecordUse, IsRefused) {
    expect_refusals({samples, writers, stages, estimates, experiments});
}

/// Huge repetition counts must not overflow.
TEST(WrongRecordUse, HugeRepetitionCountsDoNotOverflow) {
    RepeatWatch watch({0.1}, huge, 2);
    for (int i = 0; i < 10; ++i)
        watch.add({1});
    EXPECT_EQ(watch.period(), 0U);
}

} // namespace graze::record_misuse_test
