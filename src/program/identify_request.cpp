#include "program/identify_request.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "program/identify_arguments.hpp"
#include "program/record_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace graze {

namespace {

/// Reads VALUE or VALUE+-ERROR.
void read_known_value(const std::string& text, const char* option, std::string& known, double& known_error) {
    if (text.empty())
        return;
    const std::size_t sign = text.find("+-");
    const auto number = [&](const std::string& part) {
        double value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (error != std::errc() || end != part.data() + part.size() || !std::isfinite(value))
            throw InputError(Place{fmt::format("{} {}", option, text), 0, 0}, fmt::format("'{}' is no number", part),
                             "write a value, or a value and its standard error as in 1.9e-5+-2e-7");
        return value;
    };
    known = fmt::format("{}", number(text.substr(0, sign)));
    known_error = sign == std::string::npos ? 0 : std::abs(number(text.substr(sign + 2)));
}

std::string text_of_request(const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
}

} // namespace

StudyRun identify_request(const IdentifyArguments& arguments) {
    StudyRun run(RunKind::identify);
    IdentifyRequest& request = run.identify();
    const std::vector<std::string>& kinds = kinds_of_estimates();
    request.what =
        static_cast<IdentifyRequest::What>(std::find(kinds.begin(), kinds.end(), arguments.what) - kinds.begin());
    request.asked_as = "--";
    if (!arguments.channel.empty())
        request.channel = arguments.channel;
    request.displacement = arguments.displacement;
    if (!arguments.voltage.empty())
        request.voltage = arguments.voltage;
    if (!arguments.current.empty())
        request.current = arguments.current;
    request.peaks = arguments.peaks;
    request.impacts = arguments.impacts;
    request.gap = text_of_request(arguments.gap);
    request.gap_error = arguments.gap_error;
    request.stiffness = text_of_request(arguments.stiffness);
    request.stiffness_error = arguments.stiffness_error;
    if (!arguments.noise.empty()) {
        request.displacement_noise = arguments.noise[0];
        request.current_noise = arguments.noise[1];
    }
    request.each_row = true;
    request.frequency = text_of_request(arguments.frequency);
    read_known_value(arguments.beta1, "--beta1", request.beta1, request.beta1_error);
    read_known_value(arguments.beta2, "--beta2", request.beta2, request.beta2_error);
    request.clamped = text_of_request(arguments.clamped);
    return run;
}

EachRecord identify_files(const IdentifyArguments& arguments, const Console& console) {
    return [&arguments, &console](const auto& work) {
        for (const std::string& file : arguments.reading.files)
            with_place({file, 0, 0}, [&] {
                ProcessedRecord record(file, record_processing(arguments.reading, console));
                work(file, record.source());
            });
    };
}

} // namespace graze
