#include "graze/acquire/generator_client.hpp"

#include "graze/symbolic/input_error.hpp"
#include "graze/symbolic/printable.hpp"
#include "graze/symbolic/trimmed.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>
#include <cmath>
#include <thread>

namespace graze {

namespace {

constexpr const char* who = "the generator";

/// Errors of a line that has not come as it was sent, which may come better the next time.
bool is_of_transmission(int error) {
    return (error <= -100 && error > -200) || error > 0;
}

void require_within(double value, double least, double most, const char* what) {
    if (!(value >= least && value <= most))
        throw InputError(
            fmt::format("{} of {} is beyond the limits of the experiment, {} to {}", what, value, least, most),
            "nothing was sent; change the level or the limits");
}

} // namespace

struct GeneratorClient::Setting {
    const char *name, *command, *unit;
};

std::string GeneratorClient::asked(std::string_view question) {
    line_->discard(); // late answers to earlier questions
    line_->send(question);
    const auto nobody = std::function<bool()>();
    return awaited_line(*line_, options_.timeout, making_safe_ ? nobody : options_.interrupted, who);
}

double GeneratorClient::asked_number(std::string_view question) {
    const std::string answer = asked(question);
    const char *begin = answer.data(), *const end = begin + answer.size();
    if (begin != end && *begin == '+')
        ++begin;
    double value = 0;
    const auto [next, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || next != end || !std::isfinite(value))
        throw InstrumentError(
            AcquisitionEnding::garbled,
            fmt::format("{} answers '{}' to {}", who, shortened(printable_line(answer), 100), question));
    return value;
}

/// Its oldest error, as in -113,"Undefined header". @return 0 for none
int GeneratorClient::asked_error(std::string& text) {
    text = printable_line(shortened(asked("SYST:ERR?"), 200));
    const char *begin = text.data(), *const end = begin + text.size();
    if (begin != end && *begin == '+')
        ++begin;
    int number = 0;
    const auto [next, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || next == end || *next != ',')
        throw InstrumentError(AcquisitionEnding::garbled, fmt::format("{} answers '{}' to SYST:ERR?", who, text));
    return number;
}

void GeneratorClient::take_control() {
    line_->send("SYST:REM");
    line_->send("*CLS");
}

double GeneratorClient::set(const Setting& setting, double value) {
    const auto failed = [&](AcquisitionEnding ending, const std::string& what) {
        return InstrumentError(ending, what);
    };
    for (int attempt = 1;; ++attempt) {
        const bool last = attempt >= options_.attempts;
        try {
            line_->send(fmt::format("{} {}", setting.command, value));
            std::string text;
            const int error = asked_error(text);
            if (error != 0 && !is_of_transmission(error))
                throw failed(AcquisitionEnding::refused,
                             fmt::format("{} refuses {} {} {}: {}", who, setting.name, value, setting.unit, text));
            if (error != 0)
                throw failed(AcquisitionEnding::garbled, fmt::format("{} says: {}", who, text));
            const double told = asked_number(std::string(setting.command) + "?");
            if (std::abs(told - value) <= options_.tolerance * std::abs(value))
                return told;
            throw failed(AcquisitionEnding::clipped,
                         fmt::format("{} gives {} of {} {} instead of {} {}", who, setting.name, told, setting.unit,
                                     value, setting.unit));
        } catch (const InstrumentError& error) {
            const bool again = error.ending() == AcquisitionEnding::garbled ||
                               error.ending() == AcquisitionEnding::no_answer ||
                               error.ending() == AcquisitionEnding::clipped;
            if (!again || last)
                throw;
            take_control(); // which may have been lost, too
        }
    }
}

void GeneratorClient::identify() {
    for (int attempt = 1; !identified_; ++attempt) {
        try {
            identity_ = asked("*IDN?");
            if (trimmed(identity_).empty() || !is_plain_line(identity_) ||
                identity_.find(options_.identity) == std::string::npos)
                throw InstrumentError(AcquisitionEnding::foreign,
                                      fmt::format("at the end of the line there is '{}', not '{}'",
                                                  shortened(printable_line(identity_), 100), options_.identity));
            identified_ = true;
        } catch (const InstrumentError& error) {
            if (attempt >= options_.attempts || error.ending() == AcquisitionEnding::interrupted ||
                error.ending() == AcquisitionEnding::line_lost)
                throw;
            line_->send("SYST:REM"); // without which some do not answer; it sets nothing
        }
    }
}

void GeneratorClient::begin(double frequency, double amplitude, double offset) {
    const GeneratorLimits& limits = options_.limits;
    require_within(frequency, limits.least_frequency, limits.greatest_frequency, "a frequency");
    require_within(amplitude, 0, limits.amplitude, "an amplitude");
    require_within(offset, -limits.offset, limits.offset, "an offset");
    identify();
    take_control();
    // The amplitude comes first: with the offset it may not go beyond what the generator has.
    line_->send(fmt::format("APPL:SIN {}, {}, {}", frequency, amplitude, offset));
    set({"an amplitude", "VOLT", "V"}, amplitude);
    set({"a frequency", "FREQ", "Hz"}, frequency);
    set({"an offset", "VOLT:OFFS", "V"}, offset);
}

double GeneratorClient::set_amplitude(double amplitude) {
    require_within(amplitude, 0, options_.limits.amplitude, "an amplitude");
    return set({"an amplitude", "VOLT", "V"}, amplitude);
}

double GeneratorClient::set_frequency(double frequency) {
    require_within(frequency, options_.limits.least_frequency, options_.limits.greatest_frequency, "a frequency");
    return set({"a frequency", "FREQ", "Hz"}, frequency);
}

double GeneratorClient::amplitude() {
    for (int attempt = 1;; ++attempt) {
        try {
            return asked_number("VOLT?");
        } catch (const InstrumentError& error) {
            if (attempt >= options_.attempts ||
                (error.ending() != AcquisitionEnding::garbled && error.ending() != AcquisitionEnding::no_answer))
                throw;
        }
    }
}

double GeneratorClient::frequency() {
    return asked_number("FREQ?");
}

void GeneratorClient::try_safe(double amplitude) {
    identify();
    take_control();
    set({"an amplitude", "VOLT", "V"}, amplitude);
    set({"an offset", "VOLT:OFFS", "V"}, 0);
    line_->send("SYST:LOC");
}

bool GeneratorClient::make_safe(double amplitude, std::string& problem) noexcept {
    using Clock = std::chrono::steady_clock;
    making_safe_ = true;
    const auto end = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(options_.reopen + options_.timeout));
    bool safe = false, lost = false;
    do {
        try {
            if (lost) {
                identified_ = false; // something else may be plugged in by now
                line_->reopen();
            }
            try_safe(amplitude);
            safe = true;
        } catch (const InstrumentError& error) {
            problem = error.what();
            lost = lost || error.ending() == AcquisitionEnding::line_lost;
        } catch (const std::exception& error) {
            problem = error.what();
        }
        if (!safe)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
    } while (!safe && Clock::now() < end);
    making_safe_ = false;
    return safe;
}

} // namespace graze
