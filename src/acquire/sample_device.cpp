#include "graze/acquire/sample_device.hpp"

#include "acquire/instrument_failure.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/require.hpp"
#include "graze/record/record_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace graze {

namespace {

constexpr const char* device_name = "the sample device";
using SampleClock = std::chrono::steady_clock;

/// The time that comes after so many seconds.
SampleClock::time_point after(double seconds) {
    return SampleClock::now() +
           std::chrono::duration_cast<SampleClock::duration>(std::chrono::duration<double>(seconds));
}

constexpr std::size_t rows_at_once = 1024;
constexpr double part_of_timeout = 0.25; ///< for lines that are discarded

template <class... Parts>
[[noreturn]] void fail_to_sample(fmt::format_string<Parts...> what, Parts&&... parts) {
    fail(AcquisitionEnding::samples, "{} {}", device_name, fmt::format(what, std::forward<Parts>(parts)...));
}

} // namespace

std::unique_ptr<InstrumentLine> open_sample_line(const Experiment& experiment, const Place& place) {
    const InstrumentAddress address = device_address(experiment.device, place);
    if (address.is_tcp)
        return open_tcp_line(address.name, address.port);
    SerialSettings settings;
    settings.port = address.name;
    settings.baud = experiment.sample_baud;
    settings.stop_bits = StopBits::one;
    settings.flow = FlowControl::none;
    return open_serial_line(settings);
}

TextSampleDevice::TextSampleDevice(std::shared_ptr<InstrumentLine> line, double timeout,
                                   std::function<bool()> interrupted, double patience)
    : line_(required(std::move(line), "a line")), timeout_(timeout), patience_(patience),
      interrupted_(std::move(interrupted)) {
    line_->send("STOP");
    drain();
    const std::string channels = asked("CHANNELS");
    if (channels.starts_with("ERROR"))
        refuse(channels, "");
    try {
        header_ = parse_record_header(channels, Place{device_name, 0, 0});
    } catch (const InputError&) {
        refuse(channels, "the names of its channels");
    }
    for (const Channel& channel : header_.channels) // a line with other separators
        if (channel.name.find_first_of(",;") != std::string::npos)
            refuse(channels, "the names of its channels, separated by commas,");
}

void TextSampleDevice::refuse(const std::string& line, const char* wanted) const {
    const std::string_view reason(line);
    if (reason.starts_with("ERROR"))
        fail_to_sample("says: {}",
                       shortened(printable_line(reason.substr(std::min<std::size_t>(6, reason.size()))), 200));
    fail_to_sample("says '{}' instead of {}", shortened(printable_line(line), 200), wanted);
}

std::string TextSampleDevice::asked(std::string_view question) {
    line_->send(question);
    return awaited_line(*line_, timeout_, interrupted_, device_name);
}

void TextSampleDevice::set_rate(double rate) {
    const std::string answer = asked(fmt::format("RATE {}", rate));
    double taken = 0;
    const char* const end = answer.data() + answer.size();
    if (!answer.starts_with("OK ") || std::from_chars(answer.data() + 3, end, taken).ptr != end)
        refuse(answer, "'OK' and its rate");
    constexpr double roundoff = 1e-9;
    if (!(std::abs(taken - rate) <= roundoff * rate))
        fail_to_sample("takes {} samples in a second instead of {}", taken, rate);
    rate_ = rate;
}

void TextSampleDevice::begin(std::size_t count, std::size_t block) {
    constexpr double longest = 1e9; // s, also without a rate
    const double allowed = rate_ > 0 ? timeout_ + patience_ * static_cast<double>(count) / rate_ : longest;
    latest_ = after(std::min(allowed, longest));
    line_->send(block > 0 ? fmt::format("READ {} {}", count, block) : fmt::format("READ {}", count));
    block_ = block;
    wanted_ = count;
    given_ = 0;
    last_time_ = -std::numeric_limits<double>::infinity();
    running_ = true;
}

/// Enforces the deadline for all samples: each row may arrive in time, and yet they never end.
void TextSampleDevice::require_time() const {
    if (SampleClock::now() > latest_)
        fail_to_sample("has sent only {} of {} samples, which last {:.6g} s, in {} times that time", given_, wanted_,
                       static_cast<double>(wanted_) / rate_, patience_);
}

void TextSampleDevice::parse(const std::string& row, Samples& samples) {
    const char *at = row.data(), *const end = at + row.size();
    const auto next = [&](char before) {
        double value = 0;
        if (before != '\0' && (at == end || *at++ != before))
            refuse(row, "a row of numbers");
        while (at != end && *at == ' ')
            ++at;
        const auto [behind, error] = std::from_chars(at, end, value);
        if (error != std::errc() || !std::isfinite(value))
            refuse(row, "a row of numbers");
        at = behind;
        return value;
    };
    const double time = next('\0');
    if (!(time > last_time_))
        fail_to_sample("gives the time {} after {}", time, last_time_);
    if (const double due = static_cast<double>(given_) / rate_; rate_ > 0 && !(std::abs(time - due) * rate_ <= 0.5))
        fail_to_sample("gives the time {} to its sample at {}", time, due);
    samples.values.resize(header_.channels.size());
    samples.times.push_back(time);
    for (std::vector<double>& column : samples.values)
        column.push_back(next(','));
    if (at != end)
        refuse(row, "a row of as many numbers as it has channels");
    last_time_ = time;
}

bool TextSampleDevice::read(Samples& samples) {
    samples.clear(header_.channels.size());
    const std::size_t most = block_ > 0 ? block_ : rows_at_once;
    if (running_ && block_ > 0 && given_ > 0 && given_ < wanted_)
        line_->send("MORE");
    while (running_ && (samples.rows() < most || given_ == wanted_)) {
        const std::string row = awaited_line(*line_, timeout_ + (rate_ > 0 ? 1 / rate_ : 0), interrupted_, device_name);
        if (!row.starts_with("END")) {
            if (given_ == wanted_)
                refuse(row, "the end of its samples");
            parse(row, samples);
            ++given_;
            require_time();
            continue;
        }
        running_ = false;
        std::size_t count = 0;
        const char* const end = row.data() + row.size();
        if (row.size() < 5 || std::from_chars(row.data() + 4, end, count).ptr != end || count != given_ ||
            given_ != wanted_)
            fail_to_sample("ends with '{}' after {} of {} samples", shortened(printable_line(row), 100), given_,
                           wanted_);
    }
    return samples.rows() > 0;
}

/// Discards lines until the device reports the end, or is silent for a while.
void TextSampleDevice::drain() {
    const SampleClock::time_point most = after(timeout_);
    while (SampleClock::now() < most) {
        if (interrupted_ && interrupted_())
            throw InstrumentError(AcquisitionEnding::interrupted, "interrupted");
        const auto line = line_->receive(part_of_timeout * timeout_);
        if (!line || line->starts_with("END") || line->starts_with("ERROR"))
            return;
    }
}

void TextSampleDevice::stop() {
    if (!running_)
        return;
    running_ = false;
    line_->send("STOP");
    drain();
}

bool TextSampleDevice::mark(std::uint64_t number) {
    return asked(fmt::format("MARK {}", number)).starts_with("OK");
}

bool TextSampleDevice::return_to(std::uint64_t number) {
    return asked(fmt::format("RETURN {}", number)).starts_with("OK");
}

} // namespace graze
