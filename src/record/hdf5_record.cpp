#include "record/record_formats.hpp"

#include "graze/base/physical_unit.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/text_file.hpp"
#include "record/column_names.hpp"
#include "record/hdf5_handle.hpp"
#include "record/separate_source.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace graze {

namespace {

constexpr hsize_t most_rows_of_a_part = 16'384;
constexpr hsize_t most_datasets = 1000; ///< the library needs some 200 KB for each open one
constexpr std::size_t longest_dataset_name = 100;
/// Largest chunk that is accepted: chunks are unpacked as a whole, and a small file may claim a huge one.
constexpr hsize_t largest_chunk = hsize_t{64} << 20;
/// Bytes of unpacked chunks that are cached at most, so that no chunk is unpacked again for every part.
constexpr hsize_t largest_cache = hsize_t{96} << 20;
constexpr hsize_t usual_cache = hsize_t{1} << 20; ///< bytes, the library's default
/// Largest count of numbers in a part; with many channels a part has fewer rows.
constexpr hsize_t most_numbers_of_a_part = hsize_t{1} << 22;
constexpr hsize_t fewest_rows_of_a_part = 512;
constexpr std::size_t longest_number = 16; ///< bytes
constexpr const char* advice = "give one dataset of numbers for each channel, all of one length, and one that is "
                               "called t or time";

/// One channel: a dataset.
struct Column {
    Channel channel;
    Hdf5Handle set;
    hsize_t rows = 0, chunk = 0; ///< chunk: bytes of an unpacked chunk; 0: the dataset is not chunked
};

class Hdf5Record : public SampleSource {
public:
    Hdf5Record(const std::string& path, const RecordLayout& layout) : path_(path) {
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // failures are reported by exceptions
        H5PLset_loading_state(0);                    // a file from a stranger runs no code
        open_file();
        const Hdf5Handle group = open_group(layout.group);
        find_columns(group.id());
        widen_caches(group.id());
    }
    const RecordHeader& header() const override { return header_; }

    bool read(Samples& samples) override {
        const hsize_t part =
            std::clamp(most_numbers_of_a_part / (columns_.size() + 1), fewest_rows_of_a_part, most_rows_of_a_part);
        const hsize_t count = std::min(part, rows_ - next_);
        samples.clear(columns_.size());
        if (count == 0)
            return false;
        read_column(time_, samples.times, count);
        for (std::size_t c = 0; c < columns_.size(); ++c)
            read_column(columns_[c], samples.values[c], count);
        for (std::size_t row = 0; row < samples.rows(); last_time_ = samples.times[row++])
            if (!(samples.times[row] > last_time_))
                refuse(time_, next_ + row,
                       fmt::format("the time {} is not after the one before, {}", samples.times[row], last_time_),
                       "give each row once, in the order of time");
        next_ += count;
        return true;
    }

private:
    [[noreturn]] void refuse(const std::string& problem, const std::string& remedy = advice) const {
        throw InputError(Place{path_, 0, 0}, problem, remedy);
    }
    [[noreturn]] void refuse(const Column& column, hsize_t row, const std::string& problem,
                             const std::string& remedy) const {
        refuse(fmt::format("dataset '{}', row {}: {}", column.channel.name, row + 1, problem), remedy);
    }
    Hdf5Handle handle(hid_t id, herr_t (*close)(hid_t), const std::string& problem,
                      const std::string& remedy = advice) const {
        return {id, close, path_, problem, remedy};
    }

    void read_column(const Column& column, std::vector<double>& values, hsize_t count) const {
        values.resize(count);
        const auto read_problem = "it cannot be read";
        const char* const damaged = "the file is damaged, or has been cut off; make it again";
        const Hdf5Handle source = handle(H5Dget_space(column.set.id()), H5Sclose, read_problem, damaged);
        const Hdf5Handle target = handle(H5Screate_simple(1, &count, nullptr), H5Sclose, read_problem, damaged);
        if (H5Sselect_hyperslab(source.id(), H5S_SELECT_SET, &next_, nullptr, &count, nullptr) < 0 ||
            H5Dread(column.set.id(), H5T_NATIVE_DOUBLE, target.id(), source.id(), H5P_DEFAULT, values.data()) < 0)
            refuse(column, next_, read_problem, damaged);
        for (std::size_t row = 0; row < values.size(); ++row)
            if (!std::isfinite(values[row]))
                refuse(column, next_ + row, "it is not a finite number", "leave out rows with missing values");
    }

    void open_file() {
        file_ = {};
        const char* const problem = "this HDF5 file cannot be read";
        const char* const damaged = "it is damaged, or has been cut off; make it again";
        const Hdf5Handle how = handle(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, problem, damaged);
        H5Pset_cache(how.id(), 0, H5D_CHUNK_CACHE_NSLOTS_DEFAULT, cache_, H5D_CHUNK_CACHE_W0_DEFAULT);
        file_ = {H5Fopen(path_.c_str(), H5F_ACC_RDONLY, how.id()), H5Fclose, path_, problem, damaged};
    }

    /// Opens a group, with caches small enough for all its datasets together.
    Hdf5Handle open_group(const std::string& name) {
        for (;;) {
            Hdf5Handle group(H5Gopen2(file_.id(), name.c_str(), H5P_DEFAULT), H5Gclose, path_,
                             fmt::format("there is no group '{}' in this file", printable_line(name)),
                             "name the group whose datasets are the channels");
            H5G_info_t info{};
            if (H5Gget_info(group.id(), &info) < 0)
                refuse("its datasets cannot be listed");
            if (info.nlinks > most_datasets)
                refuse(fmt::format("group '{}' has {} members, which are more than {}", printable_line(name),
                                   info.nlinks, most_datasets),
                       "give groups of fewer channels, or text");
            links_ = info.nlinks;
            if (links_ * cache_ <= largest_cache)
                return group;
            cache_ = largest_cache / links_;
            group = {};
            open_file();
        }
    }

    void find_columns(hid_t group) {
        bool has_time = false;
        for (hsize_t i = 0; i < links_; ++i)
            if (std::optional<Column> column = column_at(group, i)) {
                const std::string& name = column->channel.name;
                if (!has_time && (name == "t" || name == "time")) {
                    time_ = std::move(*column);
                    has_time = true;
                } else {
                    columns_.push_back(std::move(*column));
                }
            }
        if (!has_time || columns_.empty())
            refuse(has_time ? "there are no channels" : "there is no dataset t or time");
        header_.time = time_.channel;
        require_unit_of_time(header_, path_);
        rows_ = time_.rows;
        for (const Column& column : columns_) {
            header_.channels.push_back(column.channel);
            if (column.rows != rows_)
                refuse(fmt::format("dataset '{}' has {} rows instead of {}", column.channel.name, column.rows, rows_));
        }
    }

    /// Opens a dataset of numbers, if the link leads to one. Links to other files are ignored.
    std::optional<Column> column_at(hid_t group, hsize_t index) const {
        char name[longest_dataset_name + 2];
        const ssize_t length =
            H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, index, name, sizeof name, H5P_DEFAULT);
        H5L_info_t link{};
        if (length <= 0 || static_cast<std::size_t>(length) > longest_dataset_name || !is_plain_line(name) ||
            H5Lget_info(group, name, &link, H5P_DEFAULT) < 0)
            refuse("there is a name that is not valid for a channel");
        if (link.type != H5L_TYPE_HARD)
            return std::nullopt;
        Column column;
        column.channel.name = name;
        const std::string problem = fmt::format("dataset '{}' cannot be read", name);
        column.set = handle(H5Oopen(group, name, H5P_DEFAULT), H5Oclose, problem);
        if (H5Iget_type(column.set.id()) != H5I_DATASET)
            return std::nullopt;
        const Hdf5Handle type = handle(H5Dget_type(column.set.id()), H5Tclose, problem);
        const H5T_class_t kind = H5Tget_class(type.id());
        if (kind != H5T_FLOAT && kind != H5T_INTEGER)
            return std::nullopt;
        if (H5Tget_size(type.id()) > longest_number)
            refuse(problem + ": its numbers are too long", "write 64-bit floats");
        const Hdf5Handle space = handle(H5Dget_space(column.set.id()), H5Sclose, problem);
        if (H5Sget_simple_extent_ndims(space.id()) != 1)
            refuse(fmt::format("dataset '{}' is not a list of numbers", name));
        H5Sget_simple_extent_dims(space.id(), &column.rows, nullptr);
        column.chunk = plain_chunk(column.set.id(), H5Tget_size(type.id()), problem);
        column.channel.unit = unit_of(column.set.id());
        return column;
    }

    /// Refuses data in other files, and chunks that are too large. @return bytes of a chunk; 0: not chunked
    hsize_t plain_chunk(hid_t set, std::size_t number, const std::string& problem) const {
        const Hdf5Handle how = handle(H5Dget_create_plist(set), H5Pclose, problem);
        const H5D_layout_t layout = H5Pget_layout(how.id());
        hsize_t chunk = 0;
        if (layout == H5D_VIRTUAL || layout == H5D_LAYOUT_ERROR || H5Pget_external_count(how.id()) != 0)
            refuse(problem + ": it is kept in another file", "copy what it holds into this one");
        if (layout != H5D_CHUNKED)
            return 0;
        if (H5Pget_chunk(how.id(), 1, &chunk) != 1 || chunk > largest_chunk / number)
            refuse(problem + ": its chunks are too large", "write it in chunks of less than 64 MiB");
        return chunk * number;
    }

    /// Widens caches to a whole chunk of each channel: otherwise each part would unpack it again.
    void widen_caches(hid_t group) {
        hsize_t total = time_.chunk;
        for (const Column& column : columns_)
            total += column.chunk;
        if (total > largest_cache)
            return; // slower, but within the limits of the process
        const auto widen = [&](Column& column) {
            if (column.chunk <= cache_)
                return;
            const std::string problem = fmt::format("dataset '{}' cannot be read", column.channel.name);
            const Hdf5Handle how = handle(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose, problem);
            H5Pset_chunk_cache(how.id(), H5D_CHUNK_CACHE_NSLOTS_DEFAULT, column.chunk, H5D_CHUNK_CACHE_W0_DEFAULT);
            column.set = {}; // the cache can only change by reopening
            column.set = handle(H5Dopen2(group, column.channel.name.c_str(), how.id()), H5Dclose, problem);
        };
        widen(time_);
        std::for_each(columns_.begin(), columns_.end(), widen);
    }

    /// The unit of a dataset; empty if it has none that can be printed.
    std::string unit_of(hid_t set) const {
        if (H5Aexists(set, "units") <= 0)
            return "";
        const std::string problem = "a unit cannot be read", remedy = "give units as texts";
        const Hdf5Handle attribute = handle(H5Aopen(set, "units", H5P_DEFAULT), H5Aclose, problem, remedy);
        const Hdf5Handle type = handle(H5Aget_type(attribute.id()), H5Tclose, problem, remedy);
        const Hdf5Handle space = handle(H5Aget_space(attribute.id()), H5Sclose, problem, remedy);
        if (H5Tget_class(type.id()) != H5T_STRING || H5Sget_simple_extent_npoints(space.id()) != 1)
            return "";
        std::string unit;
        if (H5Tis_variable_str(type.id()) > 0) {
            char* text = nullptr;
            if (H5Aread(attribute.id(), type.id(), static_cast<void*>(&text)) >= 0 && text)
                unit.assign(text, strnlen(text, longest_dataset_name + 1));
            if (text)
                H5free_memory(text);
        } else if (H5Tget_size(type.id()) <= longest_dataset_name) {
            std::vector<char> text(H5Tget_size(type.id()) + 1, '\0');
            if (H5Aread(attribute.id(), type.id(), text.data()) >= 0)
                unit = text.data();
        }
        return unit.size() <= longest_dataset_name && is_plain_line(unit) ? unit_symbol(unit) : "";
    }

    std::string path_;
    Hdf5Handle file_;
    RecordHeader header_;
    Column time_;
    std::vector<Column> columns_;
    hsize_t rows_ = 0, next_ = 0, links_ = 0;
    hsize_t cache_ = usual_cache; ///< bytes of the chunk cache of a channel
    double last_time_ = -std::numeric_limits<double>::infinity();
};

} // namespace

bool is_hdf5(const std::string& path) {
    PlainFile file(path, "record");
    constexpr char signature[] = "\x89HDF\r\n\x1a\n";
    char bytes[sizeof signature - 1];
    std::size_t count = 0;
    while (count < sizeof bytes) {
        const std::size_t more = file.read(bytes + count, sizeof bytes - count);
        if (more == 0)
            return false;
        count += more;
    }
    return std::memcmp(bytes, signature, sizeof bytes) == 0;
}

std::unique_ptr<SampleSource> open_hdf5_record(const std::string& path, const RecordLayout& layout) {
    // The library crashes on some damaged files (1.10 reads strings and compact data beyond their ends).
    return std::make_unique<SeparateSource>(path, [&] { return std::make_unique<Hdf5Record>(path, layout); });
}

} // namespace graze
