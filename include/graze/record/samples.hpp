#pragma once

#include "graze/base/borrowed.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// Name and unit of a column of a record.
struct Channel {
    std::string name, unit; ///< the unit is empty if it is unknown

    /// Such as "V [V]", or only the name.
    std::string titled() const { return unit.empty() ? name : name + " [" + unit + "]"; }
};

/// Names and units of a record's time and channels.
struct RecordHeader {
    Channel time{"t", ""};
    std::vector<Channel> channels;

    /// Returns the first line of a text of this record, such as "t [s], V [V]".
    std::string heading() const;
    /// Returns the index of a channel. @param asked the option that names it, such as "--reference", for messages
    /// @throws InputError for an unknown channel, with the nearest name
    std::size_t channel(std::string_view name, std::string_view asked) const;
    /// Indices of the channels of these names; of all channels where there are no names. @throws InputError likewise
    std::vector<std::size_t> chosen_channels(const std::vector<std::string>& names, std::string_view asked) const;
};

/// Rows of a record, column by column: all of them, or a part.
struct Samples {
    std::vector<double> times;               ///< strictly increasing
    std::vector<std::vector<double>> values; ///< one vector for each channel, each as long as `times`

    std::size_t rows() const { return times.size(); }
    /// Removes all rows, and sets the number of channels.
    void clear(std::size_t channels);
    /// Appends rows first ... last - 1 of others. @throws InputError for fewer rows, or other channels
    void append(const Samples& others, std::size_t first, std::size_t last);
    void append(const Samples& others) { append(others, 0, others.rows()); }
    /// Removes the first rows. @throws InputError for fewer rows
    void drop_front(std::size_t rows);
};

/// A source of samples, read in parts: a file, or a stage that processes the samples of another source.
class SampleSource {
public:
    SampleSource() = default;
    virtual ~SampleSource() = default;
    SampleSource(const SampleSource&) = delete;
    SampleSource& operator=(const SampleSource&) = delete;

    /// The same as long as the source lives.
    virtual const RecordHeader& header() const = 0;
    /// Replaces `samples` by the next ones, at most some ten thousand rows.
    /// @return false at the end; `samples` then has no rows
    /// @throws InputError for invalid data
    virtual bool read(Samples& samples) = 0;
};

/// A record in memory, as a source.
class StoredSamples : public SampleSource {
public:
    /// @param part rows that one call of `read` returns
    /// @throws InputError unless each channel has a finite value at each time, and times strictly increase
    StoredSamples(RecordHeader header, Samples samples, std::size_t part = 65536);
    const RecordHeader& header() const override { return header_; }
    bool read(Samples& samples) override;
    /// The same record from its beginning. It shares the samples, so that several threads may read a record at once.
    std::unique_ptr<StoredSamples> again() const;

private:
    StoredSamples(RecordHeader header, std::shared_ptr<const Samples> samples, std::size_t part);
    RecordHeader header_;
    std::shared_ptr<const Samples> samples_;
    std::size_t part_, next_ = 0;
};

/// Reads a source to its end. @param most largest number of rows
/// @throws InputError for more rows
Samples read_all(SampleSource& source, std::size_t most);

} // namespace graze
