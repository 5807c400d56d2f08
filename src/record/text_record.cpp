#include "record/record_formats.hpp"

#include "base/character.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/printable.hpp"
#include "graze/base/trimmed.hpp"
#include "record/column_names.hpp"
#include "record/text_lines.hpp"
#include "record/text_number.hpp"
#include "record/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <limits>

namespace graze {

namespace {

constexpr std::size_t rows_of_a_part = 16'384;

const char* past_blanks(const char* at, const char* end) {
    while (at != end && is_blank(*at))
        ++at;
    return at;
}

/// End of a field: the separator, or the end of the line.
const char* end_of_field(const char* at, const char* end, char separator) {
    if (separator != ' ') {
        const void* const found = std::memchr(at, separator, static_cast<std::size_t>(end - at));
        return found ? static_cast<const char*>(found) : end;
    }
    while (at != end && !is_blank(*at))
        ++at;
    return at;
}

/// A record in a text file.
class TextRecord : public SampleSource {
public:
    TextRecord(const std::string& path, const RecordLayout& layout)
        : lines_(path), table_(find_table(lines_, layout)), numbers_(table_.decimal), remark_(layout.remark),
          last_time_(-std::numeric_limits<double>::infinity()) {
        row_.resize(table_.columns());
        require_unit_of_time(table_.header, path);
    }
    const RecordHeader& header() const override { return table_.header; }
    bool read(Samples& samples) override {
        samples.clear(table_.header.channels.size());
        std::string_view line;
        bool more = true;
        while (samples.rows() < rows_of_a_part && (more = next_line(line)))
            parse(line, samples);
        if (!more)
            tell();
        return samples.rows() > 0;
    }

private:
    [[noreturn]] void refuse(std::string_view line, const char* at, const std::string& problem,
                             const std::string& remedy) const {
        throw InputError(Place{lines_.path(), line_, static_cast<int>(at - line.data()) + 1}, problem, remedy);
    }

    [[noreturn]] void refuse_field(std::string_view line, std::string_view field) const {
        const std::string text = printable_line(shortened(field, 100));
        if (table_.starts_again)
            refuse(line, field.data(), fmt::format("'{}' is not a number: another heading begins here", text),
                   "give a file for each measurement");
        // A number followed by something else: another separator, or another decimal sign.
        double value = 0;
        const char *const begin = field.data(), *const end = begin + field.size();
        const char* const read = NumberReader::read_beginning(begin, end, value);
        const char* const behind = read != begin && read != end ? read : nullptr;
        if (behind && *behind == ',' && numbers_.decimal() == '.')
            refuse(line, behind, fmt::format("'{}' has a comma, and numbers before it have decimal points", text),
                   "write all numbers with the same decimal sign, and none between thousands");
        if (behind && behind + 1 != end && std::string_view(":/-").find(*behind) != std::string_view::npos &&
            std::isdigit(static_cast<unsigned char>(behind[1])))
            refuse(line, begin, fmt::format("'{}' is a time of day or a date", text),
                   "write times as numbers, as seconds from the first row on");
        if (field.size() > 2 && field.front() == '"' && field.back() == '"')
            refuse(line, begin, fmt::format("'{}' is in quotes", text), "write numbers without quotes");
        if (behind && numbers_.decimal() != ',')
            refuse(line, behind, fmt::format("'{}' follows a number", printable_line(std::string_view(behind, 1))),
                   table_.separator == ' '
                       ? std::string("separate columns by blanks, as in the first line, and write decimal points")
                       : fmt::format("separate columns by '{}', as in the first line", table_.separator));
        refuse(line, field.data(), fmt::format("'{}' is not a finite number", text),
               line_ == 1 ? "give names of columns, as in 't [s], V [V]', or numbers"
               : rows_ > 0
                   ? "write numbers, and nothing where a value is missing; other lines are skipped "
                     "if they begin with #"
                   : "write numbers, and nothing where a value is missing; lines before the names of columns can "
                     "be passed over");
    }

    /// Finds the next line that is neither empty nor a comment. @return false at the end of the file
    bool next_line(std::string_view& line) {
        while (kept_ < table_.first.size()) {
            const KeptLine& one = table_.first[kept_++];
            line = one.text;
            line_ = one.number;
            is_ended_ = one.is_ended;
            return true;
        }
        while (lines_.next(line)) {
            line_ = lines_.number();
            is_ended_ = lines_.is_ended();
            const std::string_view text = trimmed(line);
            if (!text.empty() && text.front() != '#' && text.front() != '%')
                return true;
        }
        return false;
    }

    [[noreturn]] void refuse_rest(std::string_view line, const char* at) const {
        const std::size_t columns = row_.size();
        if (table_.separator == ',' && row_fields(line, ',').size() == 2 * columns)
            refuse(line, line.data(), fmt::format("there are {} numbers instead of {}", 2 * columns, columns),
                   "give one for each column; decimal commas need columns that semicolons or tabs separate");
        refuse(line, at, fmt::format("this line has more than {} columns", columns),
               "give one number for each column that the first line names");
    }

    /// Reads the numbers of a line into `row_`. @return false if one is missing
    bool read_row(std::string_view line) {
        const char* at = line.data();
        const char* const end = at + line.size();
        const char separator = table_.separator;
        const std::size_t fields = table_.passed_over + row_.size();
        bool whole = true, is_last = false;
        for (std::size_t k = 0; k < fields; ++k) {
            if (separator == ' ')
                at = past_blanks(at, end);
            if (is_last || (separator == ' ' && at == end && k > 0))
                refuse(line, end, fmt::format("the line has {} columns instead of {}", k, fields),
                       "give a number for each column; a file that ends here has been cut off");
            const char* const stop = end_of_field(at, end, separator);
            const std::string_view field = trimmed({at, static_cast<std::size_t>(stop - at)});
            if (k >= table_.passed_over) {
                const FieldKind kind = numbers_.read(field, separator != ',', row_[k - table_.passed_over]);
                if (kind == FieldKind::text)
                    refuse_field(line, field);
                whole = whole && kind == FieldKind::number;
            }
            is_last = stop == end;
            at = is_last || k + 1 == fields ? stop : stop + 1;
        }
        const bool has_rest =
            std::any_of(at, end, [&](char letter) { return !is_blank(letter) && letter != separator; });
        if (has_rest && !table_.has_comment)
            refuse_rest(line, past_blanks(at, end));
        return whole;
    }

    void parse(std::string_view line, Samples& samples) {
        if (!is_ended_) { // its last number may be incomplete
            cut_ = line_;
            return;
        }
        const bool whole = read_row(line);
        const auto number = static_cast<double>(rows_++);
        if (!whole) {
            first_missing_ = missing_++ == 0 ? line_ : first_missing_;
            return;
        }
        const bool has_time = !table_.time || table_.time->by_column;
        const double told = has_time ? row_.front() : number;
        const double time = table_.time ? table_.time->start + table_.time->step * told : told;
        if (!(time > last_time_))
            refuse(line, past_blanks(line.data(), line.data() + line.size()),
                   fmt::format("the time {} is not after the one before, {}", time, last_time_),
                   "give each row once, in the order of time, and times with enough digits");
        last_time_ = time;
        samples.times.push_back(time);
        for (std::size_t c = 0; c < table_.header.channels.size(); ++c)
            samples.values[c].push_back(row_[c + (has_time ? 1 : 0)]);
    }

    /// Reports what was left out, once, at the end.
    void tell() {
        if (told_ || !remark_)
            return;
        told_ = true;
        if (missing_ > 0)
            remark_(fmt::format("{}: {} of {} rows are left out, as a value is missing (the first in line {})",
                                lines_.path(), missing_, rows_, first_missing_));
        if (cut_ > 0)
            remark_(fmt::format("{}: line {}, the last one, has no end and may have been cut off: it is left out",
                                lines_.path(), cut_));
    }

    TextLines lines_;
    TextTable table_;
    NumberReader numbers_;
    RecordRemark remark_;
    std::size_t kept_ = 0; ///< number of the table's first lines that were used
    int line_ = 0;
    bool is_ended_ = true;
    double last_time_;
    std::vector<double> row_;
    std::size_t rows_ = 0, missing_ = 0; ///< rows, and rows with missing values
    int first_missing_ = 0, cut_ = 0;    ///< line numbers; 0: none
    bool told_ = false;
};

} // namespace

std::unique_ptr<SampleSource> open_text_record(const std::string& path, const RecordLayout& layout) {
    return std::make_unique<TextRecord>(path, layout);
}

} // namespace graze
