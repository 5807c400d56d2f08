#include "graze/record/samples.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "graze/base/require.hpp"
#include "graze/symbolic/parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace graze {

std::string RecordHeader::heading() const {
    std::string text = time.titled();
    for (const Channel& channel : channels)
        text += ", " + channel.titled();
    return text;
}

std::vector<std::size_t> RecordHeader::chosen_channels(const std::vector<std::string>& names,
                                                       std::string_view asked) const {
    std::vector<std::size_t> chosen;
    for (const std::string& name : names)
        chosen.push_back(channel(name, asked));
    for (std::size_t c = 0; names.empty() && c < channels.size(); ++c)
        chosen.push_back(c);
    return chosen;
}

std::size_t RecordHeader::channel(std::string_view name, std::string_view asked) const {
    std::vector<std::string> names;
    for (const Channel& one : channels)
        names.push_back(one.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end())
        return static_cast<std::size_t>(found - names.begin());
    if (name == time.name)
        throw InputError(
            Place{std::string(asked), 0, 0},
            fmt::format("'{}' is the first column of the record, which is the time and not a channel", name),
            "insert a first column with the times or numbers of the rows");
    const std::string nearest = nearest_name(std::string(name), names);
    throw InputError(Place{std::string(asked), 0, 0}, fmt::format("the record has no channel '{}'", name),
                     nearest.empty() ? fmt::format("its channels are: {}", name_list(names, name))
                                     : fmt::format("did you mean '{}'?", nearest));
}

void Samples::clear(std::size_t channels) {
    times.clear();
    values.resize(channels);
    for (std::vector<double>& column : values)
        column.clear();
}

void Samples::append(const Samples& others, std::size_t first, std::size_t last) {
    require_room(others.rows(), last, "rows");
    require_room(last, first, "rows before the last");
    if (!times.empty())
        require_size(others.values.size(), values.size(), "channels");
    for (const std::vector<double>& column : others.values)
        require_size(column.size(), others.rows(), "samples of a channel");
    const auto from = static_cast<std::ptrdiff_t>(first), to = static_cast<std::ptrdiff_t>(last);
    times.insert(times.end(), others.times.begin() + from, others.times.begin() + to);
    values.resize(others.values.size());
    for (std::size_t c = 0; c < values.size(); ++c)
        values[c].insert(values[c].end(), others.values[c].begin() + from, others.values[c].begin() + to);
}

void Samples::drop_front(std::size_t rows) {
    require_room(times.size(), rows, "rows");
    for (const std::vector<double>& column : values)
        require_room(column.size(), rows, "samples of a channel");
    const auto count = static_cast<std::ptrdiff_t>(rows);
    times.erase(times.begin(), times.begin() + count);
    for (std::vector<double>& column : values)
        column.erase(column.begin(), column.begin() + count);
}

StoredSamples::StoredSamples(RecordHeader header, Samples samples, std::size_t part)
    : StoredSamples(std::move(header), std::make_shared<const Samples>(std::move(samples)), part) {
    require_size(samples_->values.size(), header_.channels.size(), "channels");
    require_finite(samples_->times, "a time of a record");
    for (const std::vector<double>& column : samples_->values) {
        require_size(column.size(), samples_->rows(), "samples of a channel");
        require_finite(column, "a sample of a record");
    }
    if (std::adjacent_find(samples_->times.begin(), samples_->times.end(),
                           [](double one, double next) { return !(next > one); }) != samples_->times.end())
        throw InputError("the times of a record do not increase", "give each row once, in the order of time");
}

StoredSamples::StoredSamples(RecordHeader header, std::shared_ptr<const Samples> samples, std::size_t part)
    : header_(std::move(header)), samples_(std::move(samples)), part_(std::max<std::size_t>(1, part)) {}

std::unique_ptr<StoredSamples> StoredSamples::again() const {
    return std::unique_ptr<StoredSamples>(new StoredSamples(header_, samples_, part_)); // a private constructor
}

bool StoredSamples::read(Samples& samples) {
    samples.clear(samples_->values.size());
    const std::size_t last = std::min(next_ + part_, samples_->rows());
    samples.append(*samples_, next_, last);
    next_ = last;
    return samples.rows() > 0;
}

Samples read_all(SampleSource& source, std::size_t most) {
    Samples all, part;
    all.clear(source.header().channels.size());
    while (source.read(part)) {
        if (all.rows() + part.rows() > most)
            throw InputError(fmt::format("the record has more than {} samples", most),
                             "filter and decimate it, or take a part of it");
        all.append(part);
    }
    return all;
}

} // namespace graze
