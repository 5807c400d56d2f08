#include "program/record_request.hpp"

#include "graze/base/input_error.hpp"
#include "program/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace graze {

namespace {

double number_of(const std::string& text, const Place& place) {
    if (const std::optional<double> value = finite_number_in(text))
        return *value;
    throw InputError(place, fmt::format("'{}' is no number", text),
                     "write NAME=FACTOR, NAME=FACTOR+OFFSET or NAME=FACTOR+OFFSET:UNIT");
}

/// Reads NAME=FACTOR[+OFFSET][:UNIT].
RecordProcessing::Scale scale_of(const std::string& text) {
    const Place place{"--scale " + text, 0, 0};
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
        throw InputError(place, "it names no channel", "write NAME=FACTOR, such as q=2.011:mm");
    RecordProcessing::Scale result;
    result.channel = text.substr(0, equals);
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

/// Reads phases: parts of a period, 0 without any.
std::vector<double> phases_of(const std::vector<std::string>& asked) {
    std::vector<double> phases;
    for (const std::string& text : split_list(asked)) {
        const std::optional<double> value = finite_number_in(text);
        if (!value || !(*value >= 0 && *value < 1))
            throw InputError(Place{"--phase " + text, 0, 0}, "it is no part of a period",
                             "give numbers from 0 to less than 1, such as 0,0.25,0.5");
        phases.push_back(*value);
    }
    return phases.empty() ? std::vector<double>{0} : phases;
}

} // namespace

RecordProcessing record_processing(const RecordArguments& arguments, const Console& console) {
    RecordProcessing processing = arguments.processing;
    processing.layout.remark = [&console](const std::string& text) {
        console.err << fmt::format("graze: warning: {}\n", text);
    };
    for (const std::string& text : arguments.scales)
        processing.scales.push_back(scale_of(text));
    return processing;
}

RecordTableRequest record_table_request(const RecordArguments& arguments) {
    RecordTableRequest request = arguments.request;
    const std::vector<std::string> tables = record_table_names();
    request.what =
        static_cast<RecordTableRequest::What>(std::find(tables.begin(), tables.end(), arguments.what) - tables.begin());
    request.channels = split_list(request.channels);
    request.phases = phases_of(arguments.phases);
    request.negated = split_list(request.negated);
    request.drawn = !arguments.plot.empty();
    return request;
}

} // namespace graze
