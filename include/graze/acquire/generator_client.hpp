#pragma once

#include "graze/acquire/instrument_line.hpp"

#include <functional>
#include <limits>
#include <string>

namespace graze {

/// What must never be sent to a generator.
struct GeneratorLimits {
    double amplitude = 0; ///< largest, in V from peak to peak
    double offset = 0;    ///< largest of either sign, in V
    double least_frequency = 0, greatest_frequency = std::numeric_limits<double>::infinity(); ///< in Hz
};

struct GeneratorOptions {
    GeneratorLimits limits;
    double timeout = 2;      ///< s, for each answer
    int attempts = 3;        ///< at each setting, where lines are lost or garbled
    double tolerance = 1e-3; ///< of what it tells of a setting, relative to it
    std::string identity{};  ///< what it answers to *IDN? must have this in it
    double reopen = 5;       ///< s, for which a lost line is tried again so that the output becomes safe
    std::function<bool()> interrupted{};
};

/// A function generator at the end of a line, spoken to in SCPI. What is set is asked for again, and so are errors: a
/// setting counts when the generator itself tells it.
class GeneratorClient {
public:
    /// @param line must outlive this
    GeneratorClient(InstrumentLine& line, GeneratorOptions options) : line_(&line), options_(std::move(options)) {}

    /// Asks what it is. Nothing is set before, neither here nor in order to become safe. @throws InstrumentError
    void identify();
    /// Takes it under remote control and has it give a sine. @throws InstrumentError, here and below, when it does not
    ///         answer, refuses, or gives something else; InputError for what is beyond the limits, of which nothing is
    ///         sent
    void begin(double frequency, double amplitude, double offset);
    /// @return what the generator says that it gives
    double set_amplitude(double amplitude);
    double set_frequency(double frequency);
    /// What it gives now.
    double amplitude();
    double frequency();
    /// What it answers to *IDN?.
    const std::string& identity() const { return identity_; }

    /// Brings the output to a safe amplitude without offset, whatever has happened before; opens a lost line again.
    /// Nobody can interrupt it. @return whether the generator says that it is there; if not, `problem` says why
    bool make_safe(double amplitude, std::string& problem) noexcept;

private:
    struct Setting;
    std::string asked(std::string_view question);
    double asked_number(std::string_view question);
    int asked_error(std::string& text);
    double set(const Setting& setting, double value);
    void take_control();
    void try_safe(double amplitude);

    InstrumentLine* line_;
    GeneratorOptions options_;
    std::string identity_;
    bool identified_ = false;
    bool making_safe_ = false;
};

} // namespace graze
