#include "graze/layout/device_file.hpp"

#include "design/design_keys.hpp"
#include "graze/base/file_name.hpp"
#include "graze/base/text_file.hpp"
#include "graze/base/with_place.hpp"
#include "graze/design/design.hpp"
#include "graze/model/catalogue.hpp"
#include "layout/quantity_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace graze {

namespace {

constexpr std::string_view given_beside = "given ";
constexpr std::size_t most_values = 10'000;
constexpr double largest_spread = 1e3; // um or degrees
constexpr const char* length_units = "nm, um, mm, cm or m";

using Wafer = LengthField<WaferPlan>;
constexpr std::array wafer_table{
    Wafer{"diameter", &WaferPlan::diameter, "of the wafer"},
    Wafer{"flat_length", &WaferPlan::flat_length, "of the flat; 0: none", true},
    Wafer{"exclusion", &WaferPlan::exclusion, "of the ring at the edge without devices", true},
    Wafer{"radius", &WaferPlan::radius, "of the circle of the devices", true},
    Wafer{"mark_radius", &WaferPlan::mark_radius, "of the circle of the wafer's marks"},
    Wafer{"mark_size", &WaferPlan::mark_size, "of the wafer's marks; 0: none", true},
    Wafer{"label_height", &WaferPlan::label_height, "of the letters on the wafer; 0: none", true},
};

/// Names of the fields of some tables, then further names.
template <class... Tables>
std::vector<std::string> names_of(std::initializer_list<const char*> others, const Tables&... tables) {
    std::vector<std::string> names;
    const auto add = [&](const auto& table) {
        for (const auto& field : table)
            names.emplace_back(field.name);
    };
    (add(tables), ...);
    names.insert(names.end(), others.begin(), others.end());
    return names;
}

/// Null when a table has no field of that name.
template <class Table>
auto field_named(const Table& table, std::string_view name) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& field) { return name == field.name; });
    return found == table.end() ? nullptr : &*found;
}

void require_within(double value, const std::string& what, const char* unit, double least, double greatest) {
    if (!(value >= least && value <= greatest))
        throw InputError(fmt::format("{} is {:.6g}{}{}", what, value, *unit ? " " : "", unit),
                         fmt::format("give a number from {} to {}", least, greatest));
}

/// Reads the sections of a design file that define the drawing; after an error in one the others are still read.
class DeviceFileReader {
public:
    explicit DeviceFileReader(const std::string& file) : reader_(file) { result_.file = file; }

    DeviceFile read(const toml::table& root, const GivenLengths& given) {
        bool drawn = false;
        StudyReader::each(reader_.toml().entries(root, ""), [&](const TomlEntry& entry) {
            mistakes_.attempt([&] {
                require_design_key(reader_.toml(), entry);
                drawn = drawn || entry.name == "device";
                read(entry);
            });
        });
        mistakes_.throw_noted();
        if (result_.name.empty())
            throw InputError(Place{result_.file, 1, 1}, "the design has no name",
                             "give name = \"...\" in its first line");
        if (!drawn)
            throw InputError(Place{result_.file, 1, 1}, "the design has no device to be drawn",
                             "add a table [device] with its dimensions (docs/layout.md)");
        for (const auto& one : given)
            mistakes_.attempt([&] { take(one.first, one.second); });
        mistakes_.throw_noted();
        require_layer();
        return std::move(result_);
    }

private:
    Place place_of(const TomlEntry& entry) const { return reader_.toml().place(*entry.node); }

    void read(const TomlEntry& entry) {
        if (entry.name == "name") {
            result_.name = reader_.toml().string(entry);
            require_file_name(result_.name, "name of a design", place_of(entry));
        } else if (entry.name == "model") {
            const std::string model = reader_.toml().string(entry);
            result_.model = is_model_path(model) ? beside(result_.file, model) : model;
            result_.places.emplace(entry.name, place_of(entry));
        } else if (entry.name == "text") {
            result_.text = reader_.toml().string(entry);
        } else if (entry.name == "device") {
            read_section(entry, names_of({"folds"}, device_fields()), [&](const TomlEntry& item) {
                if (item.name != "folds")
                    return read_length(device_fields(), item, result_.device);
                result_.device.folds = reader_.count(item, 1, most_folds);
                return true;
            });
        } else if (entry.name == "process") {
            read_section(entry, names_of({}, process_fields(), condition_fields()), [&](const TomlEntry& item) {
                return read_length(process_fields(), item, result_.process) ||
                       read_number(condition_fields(), item, result_.conditions);
            });
        } else if (entry.name == "rules") {
            read_section(entry, names_of({}, rule_fields()), [&](const TomlEntry& item) { return read_rule(item); });
        } else if (entry.name == "spread") {
            result_.places.emplace(entry.name, entry.place);
            read_spread(entry);
        } else if (entry.name == "wafer") {
            read_section(entry, names_of({"devices", "label", "vary"}, wafer_table),
                         [&](const TomlEntry& item) { return read_wafer_key(item); });
        }
    }

    /// Reads the keys of a section, and notes their places. @param read false for a key that the section does not have
    template <class Read>
    void read_section(const TomlEntry& section, const std::vector<std::string>& known, const Read& read) {
        result_.places.emplace(section.path, section.place);
        reader_.each_of(section, {}, [&](const TomlEntry& item) {
            result_.places.emplace(item.path, place_of(item));
            if (!read(item))
                throw InputError(item.place, fmt::format("unknown key '{}' in {}", item.name, section.path),
                                 study_name_remedy(item.name, known));
        });
    }

    /// Reads a length in micrometres, rounded to the grid.
    double length(const TomlEntry& entry, bool may_be_zero) {
        const double value = read_quantity(reader_, entry, "um", length_units);
        return with_place(place_of(entry), [&] { return length_on_grid(value, entry.path, may_be_zero); });
    }
    double number(const TomlEntry& entry, const char* unit, double least, double greatest) {
        const double value = read_quantity(reader_, entry, unit);
        with_place(place_of(entry), [&] { require_within(value, entry.path, unit, least, greatest); });
        return value;
    }

    /// Sets a section's length, or number, from the entry of its name. @return whether the section has it
    template <class Table, class Section>
    bool read_length(const Table& fields, const TomlEntry& entry, Section& section) {
        const auto* field = field_named(fields, entry.name);
        if (field)
            section.*field->member = length(entry, field->may_be_zero);
        return field != nullptr;
    }
    template <class Table, class Section>
    bool read_number(const Table& fields, const TomlEntry& entry, Section& section) {
        const auto* field = field_named(fields, entry.name);
        if (field)
            section.*field->member = number(entry, field->unit, field->least, field->greatest);
        return field != nullptr;
    }

    bool read_rule(const TomlEntry& item) {
        const auto* field = field_named(rule_fields(), item.name);
        if (field && item.node->is_boolean() && !item.node->ref<bool>()) {
            result_.rules.*field->member = no_limit(*field);
            return true;
        }
        try {
            return read_number(rule_fields(), item, result_.rules);
        } catch (const InputError& error) {
            throw InputError(error.place(), error.problem(), error.remedy() + ", or false for no such rule");
        }
    }

    void read_spread(const TomlEntry& entry) {
        reader_.each_of(entry, {"bias", "thickness", "taper", "stop_gap", "correlation", "drive"},
                        [&](const TomlEntry& item) {
                            if (const auto* field = field_named(departure_fields(), item.name))
                                result_.spread.*field->spread = spread_parts(item, field->unit);
                            else if (item.name == "correlation")
                                result_.spread.correlation = number(item, "um", 0, 1e7);
                            else
                                result_.spread.tuned = reader_.choice(item, {"fixed", "tuned"}) == 1;
                        });
    }
    SpreadParts spread_parts(const TomlEntry& entry, const char* unit) {
        SpreadParts parts;
        reader_.each_of(entry, {"wafer", "radial", "device"}, [&](const TomlEntry& item) {
            if (item.name == "radial")
                parts.radial = number(item, unit, -largest_spread, largest_spread);
            else
                (item.name == "wafer" ? parts.wafer : parts.device) = number(item, unit, 0, largest_spread);
        });
        return parts;
    }

    bool read_wafer_key(const TomlEntry& item) {
        if (item.name == "devices")
            result_.wafer.devices = reader_.count(item, 1, most_devices_of_wafer);
        else if (item.name == "label")
            result_.wafer.label = reader_.toml().line(item);
        else if (item.name == "vary")
            read_section(item, names_of({"folds"}, device_fields()),
                         [&](const TomlEntry& one) { return read_varied(one); });
        else
            return read_length(wafer_table, item, result_.wafer);
        return true;
    }

    bool read_varied(const TomlEntry& item) {
        const auto* field = field_named(device_fields(), item.name);
        if (!field && item.name != "folds")
            return false;
        const std::vector<TomlEntry> items = reader_.toml().elements(item);
        if (items.empty() || items.size() > most_values)
            reader_.fail(item, fmt::format("{} has {} values", item.path, items.size()),
                         fmt::format("give from 1 to {}", most_values));
        std::vector<double>& values = result_.wafer.vary.emplace_back(item.name, std::vector<double>()).second;
        reader_.each(items, [&](const TomlEntry& one) {
            values.push_back(field ? length(one, field->may_be_zero)
                                   : static_cast<double>(reader_.count(one, 1, most_folds)));
        });
        return true;
    }

    /// Takes a number given beside the file.
    void take(const std::string& name, double value) {
        const Place place = given_place(name);
        const auto set = [&](const auto& fields, auto& section) {
            const auto* field = field_named(fields, name);
            if (field)
                section.*field->member =
                    with_place(place, [&] { return length_on_grid(value, name, field->may_be_zero); });
            return field != nullptr;
        };
        std::string section = "device";
        if (set(process_fields(), result_.process)) {
            section = "process";
        } else if (const auto* field = field_named(condition_fields(), name)) {
            section = "process";
            with_place(place, [&] { require_within(value, name, field->unit, field->least, field->greatest); });
            result_.conditions.*field->member = value;
        } else if (name == "folds") {
            if (!(value >= 1 && value <= most_folds && value == static_cast<double>(static_cast<std::size_t>(value))))
                throw InputError(place, fmt::format("folds is {}", value),
                                 fmt::format("give a whole number from 1 to {}", most_folds));
            result_.device.folds = static_cast<std::size_t>(value);
        } else if (!set(device_fields(), result_.device)) {
            throw InputError(
                place, fmt::format("a device has no dimension '{}'", name),
                study_name_remedy(name, names_of({"folds"}, device_fields(), process_fields(), condition_fields())));
        }
        result_.places.insert_or_assign(section + "." + name, place);
    }

    void require_layer() const {
        const ProcessData& process = result_.process;
        if (!(process.chamber_depth < process.wafer_thickness))
            throw InputError(result_.place(is_given_place(result_.place("process.wafer_thickness"))
                                               ? "process.wafer_thickness"
                                               : "process.chamber_depth"),
                             fmt::format("the chambers, {:.6g} um deep, leave nothing of the wafer, {:.6g} um thick",
                                         process.chamber_depth, process.wafer_thickness),
                             "give a smaller chamber_depth or a greater wafer_thickness");
    }

    StudyReader reader_;
    DeviceFile result_;
    Mistakes mistakes_;
};

} // namespace

Place DeviceFile::place(const std::string& key) const {
    for (std::string part = key; !part.empty(); part.resize(part.rfind('.') == std::string::npos ? 0 : part.rfind('.')))
        if (const auto found = places.find(part); found != places.end())
            return found->second;
    return {file, 1, 1};
}

Place given_place(const std::string& name) {
    return {std::string(given_beside) + name, 0, 0};
}

bool is_given_place(const Place& place) {
    return place.file.starts_with(given_beside);
}

double dimension_of_text(const std::string& name, const std::string& text, const Place& place) {
    if (const auto* field = field_named(condition_fields(), name))
        return quantity_of_text(text, name, field->unit, place, place);
    const bool is_length = field_named(device_fields(), name) || field_named(process_fields(), name);
    return is_length ? quantity_of_text(text, name, "um", place, place, length_units)
                     : value_of_text(Model(), text, place);
}

DeviceFile parse_device_file(std::string_view text, const std::string& file, const GivenLengths& given) {
    const toml::table root = parse_toml(text, file, "docs/layout.md shows how a device is described");
    return DeviceFileReader(file).read(root, given);
}

DeviceFile load_device_file(const std::string& name_or_path, const GivenLengths& given) {
    const std::string text = is_model_path(name_or_path) ? read_text_file(name_or_path, "design", longest_model)
                                                         : shipped_design_text(name_or_path);
    return parse_device_file(text, name_or_path, given);
}

} // namespace graze
