#include "program/identify_request.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/with_place.hpp"
#include "program/command_line.hpp"
#include "program/record_request.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace graze {

namespace {

/// Reads VALUE or VALUE+-ERROR.
void read_known_value(const std::string& text, const char* option, std::string& known, double& known_error) {
    if (text.empty())
        return;
    const std::size_t sign = text.find("+-");
    const auto number = [&](const std::string& part) {
        if (const std::optional<double> value = finite_number_in(part))
            return *value;
        throw InputError(Place{fmt::format("{} {}", option, text), 0, 0}, fmt::format("'{}' is no number", part),
                         "write a value, or a value and its standard error as in 1.9e-5+-2e-7");
    };
    known = fmt::format("{}", number(text.substr(0, sign)));
    known_error = sign == std::string::npos ? 0 : std::abs(number(text.substr(sign + 2)));
}

} // namespace

StudyRun identify_request(const IdentifyArguments& arguments) {
    StudyRun run(RunKind::identify);
    IdentifyRequest& request = run.identify();
    request = arguments.request;
    const std::vector<std::string>& kinds = kinds_of_estimates();
    request.what =
        static_cast<IdentifyRequest::What>(std::find(kinds.begin(), kinds.end(), arguments.what) - kinds.begin());
    if (!arguments.noise.empty()) {
        request.displacement_noise = arguments.noise[0];
        request.current_noise = arguments.noise[1];
    }
    request.each_row = true;
    read_known_value(arguments.beta1, "--beta1", request.beta1, request.beta1_error);
    read_known_value(arguments.beta2, "--beta2", request.beta2, request.beta2_error);
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
