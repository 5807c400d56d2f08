#include "program/record_stages.hpp"

#include "graze/record/calibrated.hpp"
#include "graze/record/derivative.hpp"
#include "graze/record/low_pass.hpp"
#include "graze/record/record_file.hpp"
#include "graze/symbolic/input_error.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace graze {

namespace {

double number_of(const std::string& text, const Place& place) {
    double value = 0;
    const char* const end = text.data() + text.size();
    const auto [next, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || next != end || !std::isfinite(value))
        throw InputError(place, fmt::format("'{}' is no number", text),
                         "write NAME=FACTOR, NAME=FACTOR+OFFSET or NAME=FACTOR+OFFSET:UNIT");
    return value;
}

/// NAME=FACTOR[+OFFSET][:UNIT]
Calibration calibration_of(const std::string& text, const RecordHeader& header) {
    const Place place{"--scale " + text, 0, 0};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
        throw InputError(place, "it names no channel", "write NAME=FACTOR, such as q=2.011:mm");
    Calibration result;
    result.channel = header.channel(text.substr(0, equals), "--scale");
    std::string rest = text.substr(equals + 1);
    if (const std::size_t colon = rest.find(':'); colon != std::string::npos) {
        result.unit = rest.substr(colon + 1);
        rest.resize(colon);
    }
    // The sign of an offset stands behind a digit or a point, that of an exponent behind its e.
    std::size_t sign = std::string::npos;
    for (std::size_t i = 1; i < rest.size(); ++i)
        if ((rest[i] == '+' || rest[i] == '-') && rest[i - 1] != 'e' && rest[i - 1] != 'E')
            sign = i;
    result.factor = number_of(rest.substr(0, sign), place);
    if (sign != std::string::npos)
        result.offset = number_of(rest.substr(rest[sign] == '+' ? sign + 1 : sign), place);
    return result;
}

} // namespace

RecordStages::RecordStages(const std::string& path, const RecordArguments& arguments) {
    RecordLayout layout;
    layout.columns = arguments.columns;
    if (!arguments.group.empty())
        layout.group = arguments.group;
    stages_.push_back(open_record(path, layout));
    CalibratedSettings calibrated;
    for (const std::string& text : arguments.scales)
        calibrated.calibrations.push_back(calibration_of(text, header()));
    constexpr double infinity = std::numeric_limits<double>::infinity();
    calibrated.begin = arguments.from.value_or(-infinity);
    calibrated.end = arguments.to.value_or(infinity);
    if (!calibrated.calibrations.empty() || arguments.from || arguments.to)
        stages_.push_back(std::make_unique<Calibrated>(source(), calibrated));
    if (arguments.pass || arguments.every > 1) {
        LowPassSettings filter;
        filter.pass = arguments.pass.value_or(0);
        filter.stop = arguments.stop.value_or(0);
        filter.every = arguments.every;
        stages_.push_back(std::make_unique<LowPass>(source(), filter));
    }
    if (!arguments.derivative.empty()) {
        DerivativeSettings derivative;
        derivative.channel = header().channel(arguments.derivative, "--derivative");
        derivative.half_width = arguments.half_width;
        stages_.push_back(std::make_unique<WithDerivative>(source(), derivative));
    }
}

std::vector<std::size_t> RecordStages::channels(const std::vector<std::string>& asked) const {
    std::vector<std::size_t> result;
    for (const std::string& name : split_list(asked))
        result.push_back(header().channel(name, "--channel"));
    for (std::size_t c = 0; asked.empty() && c < header().channels.size(); ++c)
        result.push_back(c);
    return result;
}

} // namespace graze
