#include "graze/acquire/generator_client.hpp"

#include "acquire/generator_answer.hpp"
#include "acquire/instrument_failure.hpp"
#include "base/special_numbers.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/trimmed.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

namespace graze {

namespace {

constexpr int patient = 2; ///< factor for the attempts of questions and commands that are safe to repeat

/// Whether another attempt may succeed.
bool is_worth_another(AcquisitionEnding ending) {
    return ending == AcquisitionEnding::garbled || ending == AcquisitionEnding::no_answer ||
           ending == AcquisitionEnding::clipped;
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

const GeneratorClient::Setting GeneratorClient::of_amplitude{"an amplitude", "VOLT", "V"},
    GeneratorClient::of_offset{"an offset", "VOLT:OFFS", "V"},
    GeneratorClient::of_frequency{"a frequency", "FREQ", "Hz"};

std::string GeneratorClient::asked(std::string_view question) {
    line_->discard(); // discard late answers to earlier questions
    line_->send(question);
    const auto nobody = std::function<bool()>();
    return awaited_line(*line_, options_.timeout, making_safe_ ? nobody : options_.interrupted, "the generator",
                        question);
}

double GeneratorClient::asked_number(std::string_view question) {
    const std::string answer = asked(question);
    const std::optional<double> value = answered_number(trimmed(answer));
    if (!value)
        fail(AcquisitionEnding::garbled, "the generator answers '{}' to {}", shortened(printable_line(answer), 100),
             question);
    return *value;
}

/// Reads its oldest error, such as -113,"Undefined header". @return 0 for none
int GeneratorClient::asked_error(std::string& text) {
    text = printable_line(shortened(asked("SYST:ERR?"), 200));
    const std::optional<int> number = answered_error(text);
    if (!number)
        fail(AcquisitionEnding::garbled, "the generator answers '{}' to SYST:ERR?", text);
    return *number;
}

void GeneratorClient::take_control() {
    line_->send("SYST:REM");
    line_->send("*CLS");
}

/// Whether answers belong to their questions. A late answer would be taken for that to the next question, and so on:
/// then all input is discarded until the line is silent.
bool GeneratorClient::is_in_step() {
    if (!identified_ || asked("*IDN?") == identity_)
        return true;
    constexpr int most = 100;
    for (int lines = 0; lines < most && line_->receive(options_.timeout); ++lines)
        continue;
    return false;
}

/// Repeats work while lines are lost or garbled, unless the output had to be silenced.
template <class Work>
void GeneratorClient::attempt(const Work& work, int factor) {
    for (int attempt = 1;; ++attempt) {
        try {
            return work();
        } catch (const InstrumentError& error) {
            const bool last = silenced_ || attempt >= factor * options_.attempts || !is_worth_another(error.ending());
            if (error.ending() == AcquisitionEnding::clipped && !is_in_step()) {
                if (last)
                    fail(AcquisitionEnding::garbled,
                         "answers of the generator are garbled, or come so late that they are not those to the "
                         "questions ({})",
                         error.problem());
            } else if (last) {
                throw;
            }
            take_control(); // this may have been lost, too
        }
    }
}

/// Sets a number and reads it back. @param at_once called directly after the value was sent
double GeneratorClient::set(const Setting& setting, double value, const std::function<void()>& at_once) {
    double told = 0;
    bool again = false;
    attempt([&] {
        if (again && plain_) // it may have been switched off and on, which resets its settings
            for (const Choice& choice : chosen_)
                require(choice);
        again = true;
        line_->send(fmt::format("{} {}", setting.command, value));
        if (at_once)
            at_once();
        std::string text;
        const int error = asked_error(text);
        if (error != 0 && !is_of_transmission(error))
            fail(AcquisitionEnding::refused, "the generator refuses {} {} {}: {}", setting.name, value, setting.unit,
                 text);
        if (error != 0)
            fail(AcquisitionEnding::garbled, "the generator says: {}", text);
        told = checked(setting, value);
    });
    return told;
}

void GeneratorClient::require(const Choice& choice) {
    const std::string answer = asked(choice.command + "?");
    if (!choice.is_right(compared(answer)))
        fail(AcquisitionEnding::clipped, "the generator has {} {} instead of {}: no level is sent", choice.command,
             shortened(printable_line(answer), 60), choice.value);
}

/// Chooses a setting and reads it back. @param needed false: the generator may lack it
/// @return whether it has the setting, and it is right
bool GeneratorClient::choose(const Choice& choice, bool needed) {
    bool known = true;
    int attempts = 0;
    attempt(
        [&] {
            ++attempts;
            line_->send(choice.command + " " + choice.value);
            std::string text;
            const int error = asked_error(text);
            known = !is_of_transmission(error);
            if (!known && !needed && attempts >= options_.attempts)
                return;
            if (!known)
                fail(AcquisitionEnding::garbled, "the generator does not understand {} {}: {}", choice.command,
                     choice.value, text);
            require(choice); // whatever error it reported, if the setting is right
        },
        patient);
    return known;
}

void GeneratorClient::switch_off() {
    has_switch_ = choose({"OUTP", "OFF", tells_off}, false);
}

/// Lowers the amplitude of a generator without a switch before anything else is changed: VOLT MIN is its least
/// amplitude in any unit. A generator without that command gets a number that is small in its present unit, and as
/// volts peak to peak, in case it keeps the number when the unit changes.
void GeneratorClient::quieten(double safe) {
    if (is_understood("VOLT MIN"))
        return;
    std::string unit;
    attempt([&] { unit = compared(asked("VOLT:UNIT?")); }, patient);
    constexpr double greatest_crest = 10; // peak-to-peak over root mean square; noise has 6 to 8
    if (unit == "DBM")
        line_->send("VOLT -30");
    else
        lower(safe / greatest_crest);
    take_control();
}

/// Whether it accepts a command, which is repeated if the line may have garbled it.
bool GeneratorClient::is_understood(std::string_view command) {
    bool understood = false;
    int attempts = 0;
    attempt([&] {
        line_->send(command);
        std::string text;
        understood = asked_error(text) == 0;
        if (!understood && ++attempts < options_.attempts)
            throw InstrumentError(AcquisitionEnding::garbled, text);
    });
    return understood;
}

/// Lowers the amplitude to a safe one, whatever load the generator assumes; its unit is known.
void GeneratorClient::lower(double safe) {
    double load = 0;
    attempt(
        [&] {
            const std::string answer = compared(asked("OUTP:LOAD?"));
            load = tells_load(answer, infinity) ? infinity : answered_number(answer).value_or(0);
            if (!(load > 0))
                fail(AcquisitionEnding::garbled, "the generator answers '{}' to OUTP:LOAD?",
                     shortened(printable_line(answer), 60));
        },
        patient);
    const double shown = safe * std::min(1.0, inner_by_shown(options_.load) / inner_by_shown(load));
    line_->send(fmt::format("VOLT {}", shown)); // below its range, the least amplitude stays
    take_control();
}

void GeneratorClient::prepare(double safe) {
    plain_ = silenced_ = is_on_ = false;
    chosen_.clear();
    identify();
    take_control();
    switch_off();
    if (!has_switch_)
        quieten(safe);
    line_->send("VOLT:OFFS 0"); // an offset is in volts in any unit; read back when the shape is known
    const auto add = [&](const Choice& choice) {
        choose(choice, true);
        chosen_.push_back(choice);
    };
    add({"VOLT:UNIT", "VPP", [](const std::string& told) { return told == "VPP"; }});
    lower(safe); // before settings that may raise the output: dc has no amplitude, and a burst may wait for its trigger
    double number = 0;
    attempt([&] { number = asked_number("VOLT?"); }, patient);
    for (const char* name : {"AM", "FM", "PM", "FSK", "BPSK", "PWM", "BM", "SUM", "HARM", "BURS", "SWE"})
        if (const Choice off{fmt::format("{}:STAT", name), "OFF", tells_off}; choose(off, false))
            chosen_.push_back(off);
    const auto is_one = [](const std::string& told) { return told == "CW" || told == "FIX" || told == "FIXED"; };
    if (const Choice one{"FREQ:MODE", "CW", is_one}; choose(one, false))
        chosen_.push_back(one);
    const auto is_sine = [](const std::string& told) { return told == "SIN" || told == "SINUSOID"; };
    const Choice shape{"FUNC:SHAP", "SIN", is_sine};
    require_quiet(number);
    if (choose(shape, false))
        chosen_.push_back(shape);
    else
        add({"FUNC", "SIN", is_sine});
    const double load = options_.load;
    set(of_offset, 0); // set before a change of load rescales it
    require_quiet(number);
    const bool is_infinite = inner_by_shown(load) == 1;
    add({"OUTP:LOAD", is_infinite ? "INF" : fmt::format("{}", load),
         [load](const std::string& told) { return tells_load(told, load); }});
    set(of_offset, 0); // again, as some generators keep the number instead
    offset_ = 0;
    require_plain();
    plain_ = true;
}

/// Checks the lowered amplitude before shape and load may raise the output: the generator may have been switched off
/// and on, which resets its settings.
/// @param number amplitude to which it was lowered
void GeneratorClient::require_quiet(double number) {
    require_plain();
    attempt(
        [&] {
            if (has_switch_)
                require({"OUTP", "OFF", tells_off});
            constexpr double close = 0.01;
            if (const double told = asked_number("VOLT?"); !(told <= number + close * std::abs(number)))
                fail(AcquisitionEnding::clipped,
                     "the generator has an amplitude of {} V, which was lowered to {} V: no level is sent", told,
                     number);
        },
        patient);
}

/// Checks unit, shape, load and modulations, before a level is sent and before one is accepted.
void GeneratorClient::require_plain() {
    for (const Choice& choice : chosen_)
        attempt([&] { require(choice); }, patient);
}

/// Reads back a number that was set, once.
double GeneratorClient::checked(const Setting& setting, double value) {
    const double told = asked_number(std::string(setting.command) + "?");
    if (!(std::abs(told - value) <= options_.tolerance * std::abs(value)))
        fail(AcquisitionEnding::clipped, "the generator gives {0} of {1} {2} instead of {3} {2}", setting.name, told,
             setting.unit, value);
    return told;
}

/// Checks all settings of the output but the amplitude, before a level and after it. The offset comes first: setting a
/// level may have changed it, and it adds to the voltage.
void GeneratorClient::require_beside_amplitude() {
    attempt([&] { checked(of_offset, offset_); }, patient);
    require_plain();
    attempt([&] { checked(of_frequency, frequency_); }, patient);
}

/// Switches the output off, or lowers it to the amplitude before the first level. `make_safe` reads it back.
void GeneratorClient::silence() {
    silenced_ = true;
    line_->send(has_switch_ ? std::string("OUTP OFF") : fmt::format("VOLT {}", least_));
    if (!has_switch_)
        line_->send("VOLT:OFFS 0");
    plain_ = false; // so that all settings are made again before anything else is sent
}

/// Setting a frequency may have changed the amplitude: too large a one is not read twice.
void GeneratorClient::check_no_more() {
    const double told = asked_number("VOLT?");
    if ((has_switch_ && !is_on_) ||
        told <= amplitude_ * (1 + options_.tolerance)) // with its output off there is no danger
        return;
    silence();
    fail(AcquisitionEnding::clipped,
         "the generator gives an amplitude of {} V instead of {} V since its frequency was set: its output was "
         "silenced at once",
         told, amplitude_);
}

/// Reads back all settings of the output, once each.
void GeneratorClient::check_level() {
    checked(of_amplitude, amplitude_);
    for (const Choice& choice : chosen_)
        require(choice);
    checked(of_offset, offset_);
    checked(of_frequency, frequency_);
}

/// Switches the output on. The switch itself may change the level (recall another one), so all settings are read back
/// immediately before and after, and the first wrong answer switches the output off again.
void GeneratorClient::switch_on() {
    std::string changed; // what it reported while it was on
    for (int times = 1;; ++times) {
        try {
            attempt([&] { check_level(); }, patient);
            attempt([&] { checked(of_amplitude, amplitude_); }, patient);
        } catch (const InstrumentError& error) {
            if (changed.empty() || error.ending() != AcquisitionEnding::clipped)
                throw;
            throw InstrumentError(error.ending(), changed);
        }
        if (!has_switch_)
            return;
        line_->send("OUTP ON");
        bool is_level = true; // the level failed, not only the switch
        try {
            check_level();
            is_level = false;
            std::string text;
            if (asked_error(text) != 0)
                fail(AcquisitionEnding::garbled, "the generator says after OUTP ON: {}", text);
            require({"OUTP", "ON", tells_on});
            is_on_ = true;
            return;
        } catch (const InstrumentError& error) {
            silence();
            const bool second = !changed.empty();
            if (is_level && error.ending() == AcquisitionEnding::clipped)
                changed = fmt::format("{}; so it was since OUTP ON, and it was switched off at once", error.problem());
            if (second || times >= patient * options_.attempts || !is_worth_another(error.ending()))
                throw InstrumentError(error.ending(), changed.empty() ? error.problem() : changed);
        }
        // A character of the answer may have been lost: with the output off the same question will tell.
        silenced_ = false;
        plain_ = true;
        take_control();
        choose({"OUTP", "OFF", tells_off}, true);
    }
}

void GeneratorClient::identify() {
    for (int attempt = 1; !identified_; ++attempt) {
        try {
            identity_ = asked("*IDN?");
            if (trimmed(identity_).empty() || !is_plain_line(identity_) ||
                identity_.find(options_.identity) == std::string::npos)
                fail(AcquisitionEnding::foreign, "the instrument on the line is '{}', not '{}'",
                     shortened(printable_line(identity_), 100), options_.identity);
            identified_ = true;
        } catch (const InstrumentError& error) {
            if (attempt >= options_.attempts || error.ending() == AcquisitionEnding::interrupted ||
                error.ending() == AcquisitionEnding::line_lost)
                throw;
            line_->send("SYST:REM"); // some do not answer without it; it changes no setting
        }
    }
}

void GeneratorClient::begin(double frequency, double amplitude, double offset) {
    const GeneratorLimits& limits = options_.limits;
    require_within(frequency, limits.least_frequency, limits.greatest_frequency, "a frequency");
    require_within(amplitude, 0, limits.amplitude, "an amplitude");
    require_within(offset, -limits.offset, limits.offset, "an offset");
    least_ = amplitude_ = amplitude;
    prepare(amplitude);
    // The amplitude comes first: with the offset it might exceed the generator's range.
    set(of_amplitude, amplitude);
    set_frequency(frequency);
    set(of_offset, offset);
    offset_ = offset;
    switch_on();
}

double GeneratorClient::set_amplitude(double amplitude) {
    require_within(amplitude, 0, options_.limits.amplitude, "an amplitude");
    require_beside_amplitude();
    amplitude_ = amplitude;
    const double told = set(of_amplitude, amplitude);
    require_beside_amplitude();
    return told;
}

double GeneratorClient::set_frequency(double frequency) {
    require_within(frequency, options_.limits.least_frequency, options_.limits.greatest_frequency, "a frequency");
    frequency_ = frequency;
    return set(of_frequency, frequency, [&] { check_no_more(); });
}

double GeneratorClient::amplitude() {
    require_beside_amplitude();
    double told = 0;
    attempt([&] { told = asked_number("VOLT?"); }, patient);
    return told;
}

void GeneratorClient::try_safe(double amplitude) {
    identify();
    take_control();
    silenced_ = false;
    bool stands = plain_;
    try {
        require_plain();
    } catch (const InstrumentError& error) {
        if (error.ending() != AcquisitionEnding::clipped)
            throw;
        stands = false;
    }
    if (!stands)
        prepare(amplitude); // its output stays off, if it has a switch
    amplitude_ = amplitude;
    set(of_amplitude, amplitude);
    set(of_offset, 0);
    offset_ = 0;
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
                identified_ = plain_ = false; // another instrument may be connected by now
                line_->reopen();
            }
            try_safe(amplitude);
            safe = true;
        } catch (const InstrumentError& error) {
            problem = error.problem();
            lost = lost || error.ending() == AcquisitionEnding::line_lost;
        } catch (const std::exception& error) {
            problem = error.what();
        } catch (...) { // of a line that somebody else has written
            problem = "its line has failed";
        }
        if (!safe)
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
    } while (!safe && Clock::now() < end);
    making_safe_ = false;
    return safe;
}

bool GeneratorClient::is_switched_off() noexcept {
    making_safe_ = true;
    bool off = false;
    for (int times = 0; times < options_.attempts && !off; ++times) {
        try {
            if (!has_switch_ || !identified_)
                break;
            line_->send("OUTP OFF");
            // The answer counts if questions before and after it are answered correctly.
            off = is_in_step() && tells_off(compared(asked("OUTP?"))) && is_in_step();
        } catch (...) { // not confirmed
            continue;
        }
    }
    making_safe_ = false;
    return off;
}

} // namespace graze
