#include "graze/layout/process_recipe.hpp"

#include <fmt/format.h>

#include <string_view>

namespace graze {

namespace {

/// Quotes a word for a shell, unless it is plain.
std::string shell_word(const std::string& text) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-+/=,@";
    if (!text.empty() && text.find_first_not_of(plain) == std::string::npos)
        return text;
    std::string quoted = "'";
    for (const char c : text)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string mask_command(const DeviceFile& file, const std::vector<std::string>& options, int mask) {
    std::string text = "graze layout " + shell_word(file.file);
    for (const std::string& option : options)
        text += " " + shell_word(option);
    return text + fmt::format(" --wafer --mask {} --output {}-mask{}.gds", mask, file.name, mask);
}

} // namespace

std::string recipe_text(const DeviceFile& file, const std::vector<std::string>& options) {
    const ProcessData& process = file.process;
    const ProcessConditions& conditions = file.conditions;
    // Appendix D etches 50 um in 6 min and 250 um in 38 min: the rate decreases in deep trenches.
    const double chamber_minutes = process.chamber_depth * 6 / 50;
    const double through_minutes = process.layer_thickness() * 38 / 250;
    std::string text = fmt::format("# How {} is made\n\n", file.name);
    text += fmt::format("Two wafers of {:g} mm become one stack; all that moves is {:g} um thick. Times are those of "
                        "the dissertation's "
                        "machines, scaled by depth: they are a beginning.\n\n",
                        file.wafer.diameter / 1000, process.layer_thickness());
    text += fmt::format(
        "## What it takes\n\n"
        "- wafer 1: silicon, surface (100), doped with boron (1 to 5 ohm cm), polished on both sides, {:g} um thick\n"
        "- wafer 2: silicon, polished on one side, {:g} um thick\n"
        "- mask 1 (chambers, for the back) and mask 2 (all else, for the front), chrome on glass:\n\n      {}\n      "
        "{}\n\n"
        "- photoresist SPR220 with adhesion promoter AP8000, developer 327, remover 1165\n"
        "- SU-8 epoxy that sets by heat, for a layer of {:g} um\n\n",
        process.wafer_thickness, conditions.base_thickness, mask_command(file, options, 1),
        mask_command(file, options, 2), conditions.bond_thickness);
    text += fmt::format(
        "## Chambers, in the back of wafer 1\n\n"
        "1. Clean with acetone, isopropanol and water, blow dry, and bake for 2 min at 120 C.\n"
        "2. Promoter on the back, 1 min at 110 C; resist at 3000 rpm for 30 s, 1 min at 110 C.\n"
        "3. Expose mask 1 for 20 s, develop for about a minute, rinse, dry, inspect; 2 min at 110 C.\n"
        "4. Etch {:g} um deep (reactive ions, about {:.2g} min). The chambers end {:g} um above the front.\n"
        "5. Strip the resist at 120 C, with ultrasound for the last 5 min, and clean.\n\n",
        process.chamber_depth, chamber_minutes, process.layer_thickness());
    text += "## Marks, on its front\n\n"
            "1. Resist on the front as before. Align mask 2 to the back, expose for 20 s.\n"
            "2. Develop the alignment marks alone, rinse, dry, inspect; 2 min at 110 C.\n"
            "3. Sputter aluminium for 2 min at 300 W, and lift it off with the resist.\n\n";
    text += fmt::format("## Bond\n\n"
                        "1. Spin {:g} um of SU-8 onto wafer 2, and keep it for 2 h at 60 C in vacuum.\n"
                        "2. Lay wafer 1 on it, flats aligned at the first touch, for it holds at once, and press "
                        "between heated plates in "
                        "vacuum until the epoxy has set.\n\n",
                        conditions.bond_thickness);
    text += fmt::format(
        "## Through-etch\n\n"
        "1. Promoter and resist on the front; align mask 2 to the aluminium marks, expose for 20 s, develop (which "
        "takes the "
        "aluminium away), rinse, dry, inspect; 2 min at 110 C.\n"
        "2. Etch {:g} um over the chambers, {:g} um beside them (about {:.2g} min); the epoxy stops it. The drawing "
        "expects that silicon recedes by {:g} um at the front, and that walls are {:g} degrees off the vertical.\n"
        "3. Strip at 120 C, with care for ultrasound, which breaks flexures; then acetone, methanol, and dry.\n"
        "4. Sputter aluminium on all for 20 min at 300 W. The undercut of {:g} um keeps it from joining the "
        "electrodes.\n\n",
        process.layer_thickness(), process.wafer_thickness, through_minutes, conditions.bias, conditions.taper,
        file.device.base_inset);
    text += fmt::format("## Use\n\nThe gas around the device is to have {:g} Pa: its damping depends on it.\n",
                        conditions.pressure);
    return text;
}

} // namespace graze
