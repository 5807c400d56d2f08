#include "record/text_table.hpp"

#include "base/character.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/trimmed.hpp"
#include "record/column_names.hpp"
#include "record/instrument_table.hpp"
#include "record/text_number.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace graze {

namespace {

constexpr std::size_t most_heading_lines = 1000;
constexpr std::size_t longest_heading = std::size_t{4} << 20;
constexpr char separators[] = {';', '\t', ',', ' '};

bool is_comment(std::string_view line) {
    const std::string_view text = trimmed(line);
    return text.empty() || text.front() == '#' || text.front() == '%';
}

/// Result of reading a line as a row: a row begins with a number and has only numbers and missing values.
struct RowLook {
    bool is_row = false;
    std::size_t fields = 0;  ///< number of fields, up to the last one that is not empty
    std::size_t numbers = 0; ///< numbers among them
};

RowLook look_at(std::string_view line, char separator) {
    const std::vector<std::string_view> fields = row_fields(line, separator);
    RowLook look;
    look.is_row = true;
    NumberReader reader;
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const std::string_view field = trimmed(fields[k]);
        if (field.empty())
            continue;
        double value = 0;
        const FieldKind kind = reader.read(field, separator != ',', value);
        look.is_row = look.is_row && kind != FieldKind::text && (k > 0 || kind == FieldKind::number);
        look.fields = k + 1;
        look.numbers += kind == FieldKind::number ? 1 : 0;
    }
    look.is_row = look.is_row && !fields.empty() && !trimmed(fields.front()).empty();
    return look;
}

bool is_row(std::string_view line, std::size_t least) {
    return std::any_of(std::begin(separators), std::end(separators), [&](char separator) {
        const RowLook look = look_at(line, separator);
        return look.is_row && look.numbers >= least;
    });
}

/// Whether a line is a row, perhaps with a single number, that has as many fields as a row below it.
bool is_row_like(std::string_view line, std::string_view row) {
    return std::any_of(std::begin(separators), std::end(separators), [&](char separator) {
        const std::size_t fields = row_fields(row, separator).size();
        return fields > 1 && row_fields(line, separator).size() == fields && look_at(row, separator).is_row &&
               look_at(line, separator).is_row;
    });
}

/// Whether a row has a comma within a number, besides another separator of columns.
bool has_decimal_commas(std::string_view line) {
    const auto is_digit = [](char letter) { return letter >= '0' && letter <= '9'; };
    bool commas = false, others = false;
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        commas = commas || (line[i] == ',' && is_digit(line[i - 1]) && is_digit(line[i + 1]));
        others = others || (is_blank(line[i]) && is_digit(line[i - 1]));
    }
    return commas && others;
}

/// Guesses the separator from a row alone.
char separator_of_row(std::string_view line) {
    const char separator = separator_of_names(line);
    return separator == ',' && has_decimal_commas(line) ? ' ' : separator;
}

/// Finds the separator that gives a line of names as many columns as a row. @return 0 if there is none
char common_separator(std::string_view names, std::string_view row) {
    for (const char separator : separators) {
        const std::size_t columns = name_fields(names, separator).size();
        const RowLook look = look_at(row, separator);
        const std::size_t fields = row_fields(row, separator).size();
        if (columns >= 2 && look.is_row && look.fields <= columns && fields >= columns)
            return separator;
    }
    return 0;
}

/// Finds the beginning of the rows.
class TableSearch {
public:
    TableSearch(TextLines& lines, const RecordLayout& layout) : lines_(&lines), layout_(&layout) {}

    TextTable run() {
        std::string_view line;
        const std::size_t given = std::max({layout_->skip, layout_->names_line, layout_->units_line});
        while (static_cast<std::size_t>(lines_->number()) < given) {
            if (!lines_->next(line))
                fail_given(given);
            const auto number = static_cast<std::size_t>(lines_->number());
            if (number == layout_->names_line)
                names_ = kept(line);
            if (number == layout_->units_line)
                units_ = kept(line);
        }
        std::size_t bytes = 0;
        while (heading_.size() < most_heading_lines && bytes < longest_heading && lines_->next(line)) {
            if (is_comment(line)) {
                if (!trimmed(line).empty())
                    comment_ = kept(line);
                continue;
            }
            bytes += line.size();
            if (given == 0 && heading_.empty() && layout_->columns.empty()) {
                if (is_labview(line))
                    return labview_table(*lines_);
                if (is_tektronix(line))
                    return tektronix_table(*lines_, kept(line));
            }
            if (!names_.text.empty() || !layout_->columns.empty())
                return from_layout(line);
            const std::size_t least = !heading_.empty() && has_time_in_names(heading_.back().text) ? 1 : 2;
            if (is_row(line, least))
                return below_heading(line);
            heading_.push_back(kept(line));
        }
        return without_rows();
    }

private:
    KeptLine kept(std::string_view line) const { return {std::string(line), lines_->number(), lines_->is_ended()}; }
    Place place(int line) const { return {lines_->path(), line, 1}; }

    [[noreturn]] void fail_given(std::size_t given) const {
        throw InputError(Place{lines_->path(), 0, 0},
                         fmt::format("the file has {} lines, and line {} is to be skipped or to name columns",
                                     lines_->number(), given),
                         "give numbers of lines that exist");
    }

    /// Takes names and units from given lines or text; `line` is the first row.
    TextTable from_layout(std::string_view line) {
        TextTable table;
        table.first.push_back(kept(line));
        if (!layout_->columns.empty()) {
            if (!is_row(line, 1))
                throw InputError(place(lines_->number()), "the file has a header of its own",
                                 "leave out the names of columns, or say how many lines to skip (skip)");
            table.header = parse_record_header(layout_->columns, Place{"columns", 0, 0});
            table.separator = separator_of_row(line);
            return table;
        }
        std::string_view names = names_.text;
        while (!names.empty() && (names.front() == '#' || names.front() == '%'))
            names.remove_prefix(1);
        const char separator = common_separator(trimmed(names), line);
        if (separator == 0)
            mismatch(names_, names, line);
        table.separator = separator;
        table.header = header_named(names_, trimmed(names), units_.text.empty() ? nullptr : &units_, separator);
        return table;
    }

    [[noreturn]] void mismatch(const KeptLine& names, std::string_view text, std::string_view row) const {
        const char one = separator_of_names(text), other = separator_of_row(row);
        throw InputError(place(lines_->number()),
                         fmt::format("this row has {} columns, and line {}, which should name them, has {}",
                                     row_fields(row, other).size(), names.number, name_fields(text, one).size()),
                         "say which line has the names, or pass over lines and say what the columns are");
    }

    /// Handles the first row with two numbers. Lines directly above it with one number and missing values are rows too,
    /// not names.
    TextTable below_heading(std::string_view line) {
        while (!heading_.empty() && is_row_like(heading_.back().text, line)) {
            rows_.insert(rows_.begin(), std::move(heading_.back()));
            heading_.pop_back();
        }
        rows_.push_back(kept(line));
        if (heading_.empty())
            return without_heading(line);
        if (auto table = rigol_table(heading_, lines_->path())) {
            table->first = rows_;
            return *std::move(table);
        }
        const KeptLine* names = &heading_.back();
        const KeptLine* units = nullptr;
        char separator = common_separator(names->text, line);
        if (heading_.size() > 1 && separator != 0) {
            const std::vector<NameField> below = name_fields(names->text, separator);
            const KeptLine& above = heading_[heading_.size() - 2];
            if (name_fields(above.text, separator).size() == below.size() &&
                std::all_of(below.begin(), below.end(), [](const NameField& f) { return is_unit_word(f.text); })) {
                units = names;
                names = &above;
            }
        }
        if (separator == 0 && heading_.size() > 1)
            mismatch(heading_.back(), heading_.back().text, line);
        TextTable table;
        table.first = rows_;
        if (separator == 0) { // the error will be reported for the row
            require_closed_brackets(names->text, place(names->number));
            separator = separator_of_names(names->text);
        }
        table.separator = separator;
        table.header = header_named(*names, names->text, units, separator);
        if (heading_.size() > 1)
            take_units(table.header);
        return table;
    }

    /// Makes the header of a line of names. Numbers above units (1, 2) are names of channels.
    RecordHeader header_named(const KeptLine& line, std::string_view text, const KeptLine* units,
                              char separator) const {
        if (!units)
            require_closed_brackets(text, place(line.number));
        std::vector<NameField> fields = name_fields(text, separator);
        std::vector<std::string> numbered(fields.size());
        for (std::size_t k = 1; k < fields.size() && units; ++k) {
            const std::string_view name = trimmed(fields[k].text);
            if (!name.empty() && name.find_first_not_of("0123456789") == std::string_view::npos) {
                numbered[k] = fmt::format("CH{}", name);
                fields[k].text = numbered[k];
            }
        }
        RecordHeader header = header_of(fields, place(line.number));
        const std::vector<NameField> words = units ? name_fields(units->text, separator) : std::vector<NameField>();
        for (std::size_t k = 0; k < words.size() && k < fields.size(); ++k) {
            std::string& unit = (k == 0 ? header.time : header.channels[k - 1]).unit;
            if (const std::string word = unit_of_word(words[k].text); !word.empty())
                unit = word;
        }
        return header;
    }

    /// Takes units of channels that have none from lines such as "Vertical Units,V". LeCroy gives none: times are in s.
    void take_units(RecordHeader& header) const {
        if (heading_.front().text.starts_with("LECROY") && header.time.unit.empty())
            header.time.unit = "s";
        for (const KeptLine& line : heading_) {
            std::vector<std::string_view> values;
            for (const std::string_view field : row_fields(line.text, ','))
                if (!trimmed(field).empty())
                    values.push_back(trimmed(field));
            if (values.size() < 2)
                continue;
            if (values[0] == "Horizontal Units" && header.time.unit.empty())
                header.time.unit = unit_of_time_word(values[1]);
            if (values[0] == "Vertical Units" && values.size() == header.channels.size() + 1)
                for (std::size_t c = 0; c < header.channels.size(); ++c)
                    if (header.channels[c].unit.empty())
                        header.channels[c].unit = unit_of_word(values[c + 1]);
        }
    }

    /// Remedy that suggests a comment directly above the rows with as many parts as columns: it may name the columns.
    std::string remedy_of_comment(std::string_view row) const {
        std::string_view text = comment_.text;
        text.remove_prefix(std::min(text.find_first_not_of("#% \t"), text.size()));
        return common_separator(text, row) == 0
                   ? ""
                   : fmt::format("; if the comment in line {0} does, name that line", comment_.number);
    }

    /// Handles a file that has rows only.
    TextTable without_heading(std::string_view line) {
        TextTable table;
        table.first = rows_;
        table.separator = separator_of_row(line);
        constexpr std::size_t columns_of_dissertation = 5;
        const std::size_t columns = row_fields(trimmed(line), table.separator).size();
        if (columns != columns_of_dissertation)
            throw InputError(
                place(rows_.front().number), fmt::format("the {} columns of the record are not named", columns),
                "begin the file with a line such as 't [s], V [V], q [mm]', or name them" + remedy_of_comment(line));
        table.header = {{"t", "s"}, {{"V", ""}, {"I", ""}, {"q", ""}, {"v", ""}}};
        return table;
    }

    /// Handles a file in which no row was found: the first line names the columns, and the next one is reported as an
    /// invalid row.
    TextTable without_rows() {
        if (heading_.empty())
            throw InputError(Place{lines_->path(), 0, 0}, "the record is empty",
                             "give a table of channels against time");
        TextTable table;
        double value = 0;
        const std::string_view text = trimmed(heading_.front().text);
        const bool begins_with_number =
            NumberReader::read_beginning(text.data(), text.data() + text.size(), value) != nullptr;
        if (begins_with_number && row_fields(text, separator_of_row(text)).size() > 1) {
            rows_ = {heading_.front()};
            return without_heading(heading_.front().text);
        }
        table.separator = separator_of_names(text);
        table.header = parse_record_header(heading_.front().text, place(heading_.front().number));
        table.first.assign(heading_.begin() + 1, heading_.end());
        return table;
    }

    TextLines* lines_;
    const RecordLayout* layout_;
    KeptLine names_, units_;
    KeptLine comment_; ///< the last comment above the first row
    std::vector<KeptLine> heading_;
    std::vector<KeptLine> rows_; ///< first rows, if the layout did not say where they begin
};

} // namespace

std::vector<std::string_view> row_fields(std::string_view line, char separator) {
    std::vector<std::string_view> fields;
    std::size_t begin = 0;
    for (std::size_t i = 0; i <= line.size(); ++i) {
        const bool ends = i == line.size() || (separator == ' ' ? is_blank(line[i]) : line[i] == separator);
        if (!ends)
            continue;
        if (separator != ' ' || i > begin)
            fields.push_back(line.substr(begin, i - begin));
        begin = i + 1;
    }
    return fields;
}

TextTable find_table(TextLines& lines, const RecordLayout& layout) {
    return TableSearch(lines, layout).run();
}

} // namespace graze
