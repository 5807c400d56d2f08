#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace graze {

/// What a column of a record holds.
struct Channel {
    std::string name, unit; ///< the unit is empty where nobody said it
};

/// What is known of a record before its samples: the time and the channels that are recorded against it.
struct RecordHeader {
    Channel time{"t", ""};
    std::vector<Channel> channels;

    /// Index of a channel. @param asked who asks, as in "--reference"
    /// @throws InputError when there is none of that name, with the nearest
    std::size_t channel(std::string_view name, std::string_view asked) const;
    /// Indices of the channels of these names; of all channels where there are no names. @throws InputError likewise
    std::vector<std::size_t> chosen_channels(const std::vector<std::string>& names, std::string_view asked) const;
};

/// Rows of a record, column by column: a part of it or all.
struct Samples {
    std::vector<double> times;               ///< strictly rising
    std::vector<std::vector<double>> values; ///< one vector for each channel, each as long as `times`

    std::size_t rows() const { return times.size(); }
    /// No rows of so many channels.
    void clear(std::size_t channels);
    /// Rows first ... last - 1 of others. @throws InputError where there are not so many, or other channels
    void append(const Samples& others, std::size_t first, std::size_t last);
    void append(const Samples& others) { append(others, 0, others.rows()); }
    /// The first rows go. @throws InputError where there are not so many
    void drop_front(std::size_t rows);
};

/// Where samples come from, part by part: a file, or a stage that makes them from those of another source.
class SampleSource {
public:
    SampleSource() = default;
    virtual ~SampleSource() = default;
    SampleSource(const SampleSource&) = delete;
    SampleSource& operator=(const SampleSource&) = delete;

    virtual const RecordHeader& header() const = 0;
    /// Replaces `samples` by the next ones, some ten thousands at a time.
    /// @return false when there are no more; `samples` then has none
    /// @throws InputError for what is no record
    virtual bool read(Samples& samples) = 0;
};

/// A record that is in memory already.
class StoredSamples : public SampleSource {
public:
    /// @param part rows that are handed out at a time
    /// @throws InputError unless there is a value of each channel at each of strictly rising times, all of them finite
    StoredSamples(RecordHeader header, Samples samples, std::size_t part = 65536);
    const RecordHeader& header() const override { return header_; }
    bool read(Samples& samples) override;

private:
    RecordHeader header_;
    Samples samples_;
    std::size_t part_, next_ = 0;
};

/// All that is left of a source. @param most rows
/// @throws InputError when there are more
Samples read_all(SampleSource& source, std::size_t most);

} // namespace graze
