#include "graze/record/record_writer.hpp"

#include "graze/base/input_error.hpp"
#include "graze/base/require.hpp"
#include "graze/base/trimmed.hpp"
#include "record/hdf5_handle.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <cstdio>
#include <iterator>
#include <set>
#include <string_view>
#include <utility>

namespace graze {

class RecordWriter::Target {
public:
    Target() = default;
    virtual ~Target() = default;
    Target(const Target&) = delete;
    Target& operator=(const Target&) = delete;
    virtual void write(const Samples& samples) = 0;
    virtual void close() = 0;
};

namespace {

constexpr const char* full = "look at the permissions of the folder and the room on the disk";

[[noreturn]] void refuse_to_write(const std::string& path) {
    throw FileError(path, "the record cannot be written", full);
}

/// Refuses a name that would be read back as another one, or as two.
void require_column(const Channel& channel) {
    const bool splits = channel.name.find_first_of(",;\t\n\r[]") != std::string::npos || channel.name.empty() ||
                        channel.name.find_first_of("#%") == 0 || trimmed(channel.name) != channel.name;
    if (splits || channel.unit.find_first_of("[]\n\r") != std::string::npos)
        throw InputError(fmt::format("channel '{}' cannot be a column of text", channel.titled()),
                         "give it a name without commas, semicolons and brackets, or write HDF5 (.h5)");
}

/// Refuses a header that could not be read back.
void require_names_once(const RecordHeader& header) {
    std::set<std::string_view> names{header.time.name};
    for (const Channel& channel : header.channels)
        if (!names.insert(channel.name).second)
            throw InputError(fmt::format("two columns are named '{}'", channel.name),
                             "give each column a name of its own");
}

class TextTarget : public RecordWriter::Target {
public:
    TextTarget(const std::string& path, const RecordHeader& header) : path_(path), file_(nullptr, std::fclose) {
        require_column(header.time);
        for (const Channel& channel : header.channels)
            require_column(channel);
        require_names_once(header);
        file_.reset(std::fopen(path.c_str(), "wb"));
        if (!file_)
            refuse_to_write(path);
        text_ = header.heading() + '\n';
    }
    void write(const Samples& samples) override {
        for (std::size_t row = 0; row < samples.rows(); ++row) {
            fmt::format_to(std::back_inserter(text_), "{}", samples.times[row]);
            for (const std::vector<double>& column : samples.values)
                fmt::format_to(std::back_inserter(text_), ",{}", column[row]);
            text_ += '\n';
            if (text_.size() > enough)
                flush();
        }
    }
    void close() override {
        flush();
        if (std::fclose(file_.release()) != 0)
            refuse_to_write(path_);
    }

private:
    static constexpr std::size_t enough = std::size_t{1} << 20;
    void flush() {
        if (std::fwrite(text_.data(), 1, text_.size(), file_.get()) != text_.size())
            refuse_to_write(path_);
        text_.clear();
    }
    std::string path_, text_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

class Hdf5Target : public RecordWriter::Target {
public:
    Hdf5Target(const std::string& path, const RecordHeader& header) : path_(path) {
        H5dont_atexit(); // otherwise data that a full disk refused is written again at exit, which crashes
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures are reported by exceptions
        file_ = handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
        sets_.push_back(make(header.time));
        for (const Channel& channel : header.channels)
            sets_.push_back(make(channel));
    }
    void write(const Samples& samples) override {
        append(sets_.front(), samples.times);
        for (std::size_t c = 0; c < samples.values.size(); ++c)
            append(sets_[c + 1], samples.values[c]);
        rows_ += samples.rows();
    }
    void close() override {
        if (H5Fflush(file_.id(), H5F_SCOPE_GLOBAL) < 0) // while an error can still be reported
            refuse_to_write(path_);
        sets_.clear();
        file_ = Hdf5Handle();
    }

private:
    static constexpr hsize_t chunk = 8192;
    static constexpr unsigned quick = 1; ///< level of deflate: higher ones hardly pack measured numbers any better

    Hdf5Handle handle(hid_t id, herr_t (*closer)(hid_t)) const {
        return {id, closer, path_, "the record cannot be written", full};
    }
    Hdf5Handle make(const Channel& channel) const {
        if (channel.name.find('/') != std::string::npos)
            throw InputError(fmt::format("channel '{}' cannot be a dataset of HDF5", channel.name),
                             "give it a name without a slash");
        const hsize_t none = 0, unlimited = H5S_UNLIMITED;
        const Hdf5Handle space = handle(H5Screate_simple(1, &none, &unlimited), H5Sclose);
        const Hdf5Handle how = handle(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
        H5Pset_chunk(how.id(), 1, &chunk);
        H5Pset_obj_track_times(how.id(), false); // the same record gives the same file at any time
        H5Pset_shuffle(how.id());
        H5Pset_deflate(how.id(), quick);
        Hdf5Handle set = handle(H5Dcreate2(file_.id(), channel.name.c_str(), H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT,
                                           how.id(), H5P_DEFAULT),
                                H5Dclose);
        if (channel.unit.empty())
            return set;
        const Hdf5Handle type = handle(H5Tcopy(H5T_C_S1), H5Tclose), one = handle(H5Screate(H5S_SCALAR), H5Sclose);
        H5Tset_size(type.id(), H5T_VARIABLE);
        H5Tset_cset(type.id(), H5T_CSET_UTF8);
        const Hdf5Handle attribute =
            handle(H5Acreate2(set.id(), "units", type.id(), one.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
        const char* text = channel.unit.c_str();
        if (H5Awrite(attribute.id(), type.id(), static_cast<const void*>(&text)) < 0)
            refuse_to_write(path_);
        return set;
    }
    void append(const Hdf5Handle& set, const std::vector<double>& values) const {
        const hsize_t count = values.size(), size = rows_ + count;
        if (count == 0)
            return;
        if (H5Dset_extent(set.id(), &size) < 0)
            refuse_to_write(path_);
        const Hdf5Handle target = handle(H5Dget_space(set.id()), H5Sclose),
                         source = handle(H5Screate_simple(1, &count, nullptr), H5Sclose);
        if (H5Sselect_hyperslab(target.id(), H5S_SELECT_SET, &rows_, nullptr, &count, nullptr) < 0 ||
            H5Dwrite(set.id(), H5T_NATIVE_DOUBLE, source.id(), target.id(), H5P_DEFAULT, values.data()) < 0)
            refuse_to_write(path_);
    }

    std::string path_;
    Hdf5Handle file_;
    std::vector<Hdf5Handle> sets_;
    hsize_t rows_ = 0;
};

} // namespace

RecordWriter::RecordWriter(const std::string& path, const RecordHeader& header) : channels_(header.channels.size()) {
    if (path.ends_with(".h5") || path.ends_with(".hdf5"))
        target_ = std::make_unique<Hdf5Target>(path, header);
    else
        target_ = std::make_unique<TextTarget>(path, header);
}

RecordWriter::~RecordWriter() = default;

void RecordWriter::write(const Samples& samples) {
    if (!target_)
        throw InputError("a record that is closed takes no more samples", "write all of them before it is closed");
    require_size(samples.values.size(), channels_, "channels");
    require_finite(samples.times, "time");
    for (const std::vector<double>& column : samples.values) {
        require_size(column.size(), samples.rows(), "samples of a channel");
        require_finite(column, "sample");
    }
    target_->write(samples);
}

void RecordWriter::close() {
    if (!target_)
        throw InputError("the record is closed already", "close it once");
    const std::unique_ptr<Target> last = std::move(target_); // even on failure it cannot be closed again
    last->close();
}

bool write_record(SampleSource& source, const std::vector<std::size_t>& channels, const std::string& path,
                  const std::function<bool()>& interrupted) {
    RecordHeader header{source.header().time, {}};
    for (const std::size_t c : channels) {
        require_index(c, source.header().channels.size(), "channel");
        header.channels.push_back(source.header().channels[c]);
    }
    RecordWriter writer(path, header);
    Samples samples, chosen;
    bool stopped = interrupted && interrupted();
    while (!stopped && source.read(samples)) {
        chosen.times = samples.times;
        chosen.values.clear();
        for (const std::size_t c : channels)
            chosen.values.push_back(samples.values[c]);
        writer.write(chosen);
        stopped = interrupted && interrupted();
    }
    writer.close();
    return !stopped;
}

} // namespace graze
