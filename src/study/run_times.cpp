#include "graze/study/run_times.hpp"

#include "graze/base/file_name.hpp"
#include "study/settings_fields.hpp"

#include <fmt/chrono.h>

namespace graze {

namespace {

std::string key_of(const std::string& run) {
    return "times of " + run;
}

template <class Fields, class Times>
void describe_times(Fields& fields, Times& times) {
    describe_fields(fields, "begun", times.begun, "ended", times.ended, "seconds", times.seconds);
}

} // namespace

std::string text_of(std::time_t moment) {
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(moment));
}

std::string present_time() {
    return text_of(std::time(nullptr));
}

void note_times(ResultFile& file, const std::string& run, const RunTimes& times) {
    SettingsWriter fields;
    describe_times(fields, times);
    file.set_note(key_of(run), fields.text());
}

std::optional<RunTimes> times_of(const ResultFile& file, const std::string& run) {
    const auto note = file.note(key_of(run));
    if (!note)
        return std::nullopt;
    const Place place = stored_place(file.path(), fmt::format("times of run '{}'", run));
    const Json json = parse_json(*note, place);
    RunTimes times;
    const SettingsReader fields(json, nullptr, place);
    describe_times(fields, times);
    require_plain_line(times.begun, "time", place);
    require_plain_line(times.ended, "time", place);
    return times;
}

} // namespace graze
