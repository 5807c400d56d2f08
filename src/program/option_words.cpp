#include "program/option_words.hpp"

#include <algorithm>
#include <iterator>
#include <regex>
#include <string_view>
#include <utility>
#include <vector>

namespace graze {

namespace {

/// What the library says, and what a user of the command line is told. Of a list the first that is there is replaced.
struct Words {
    std::string_view said, told;
};

/// Settings that are places of messages, and options of the same names.
constexpr std::string_view named_places[] = {
    "at",           "channel",        "contacts", "current", "derivative", "disturbance",
    "displacement", "greatest-speed", "negate",   "periods", "phase",      "port",
    "ramp",         "reference",      "scale",    "skip",    "tcp",        "voltage",
};

/// At the beginning: places, and problems that begin with settings.
constexpr Words beginnings[] = {
    {"given ", "--set "},
    {"the devices do not differ", "--plot: the devices do not differ"},
    {"time and periods cannot", "--time and --periods cannot"},
    {"time and a number of contacts cannot", "--time and a number of --contacts cannot"},
    {"periods and a number of contacts cannot", "--periods and a number of --contacts cannot"},
    {"skip and after cannot", "--skip and --after cannot"},
    {"after does not go with periods of", "--after does not go with periods of"},
};

constexpr Words remedies[] = {
    {"give a part without gaps", "give a part without gaps (graze identify ... --from T --to T)"},
    {"from its release on", "from its release on (graze identify ... --from T --to T)"},
    {"give a part of it that is free of that",
     "give a part of it that is free of that (graze identify ... --from T --to T)"},
    {"filter out higher frequencies", "filter out higher frequencies by graze record FILE --pass F --write FILE"},
    {"(scale in the run that has the record)", "(--scale NAME=FACTOR, or scale in the run that has the record)"},
    {"use another unit (scale ", "use another unit (graze identify ... --scale "},
    {"and take three peaks or more", "and let --peaks be three or more"},
    {"give velocities relative to the stop",
     "give velocities relative to the stop (graze record FILE --what impacts shows them)"},
    {"look at the sign of the current or the voltage",
     "look at the sign of the current or the voltage (--scale NAME=-1)"},
    {"look at the transitions of the model", "graze check MODEL lists the transitions; --graph FILE draws them"},
    {"or choose another one by parameter", "or choose another one by --parameter"},
    {"name a parameter that does", "name a parameter that does by --parameter NAME"},
    {"or draw it all the same", "or draw it all the same by --despite-rules"},
    {"let `part` leave some", "let --from and --to leave some"},
    {"give time T", "give --time T"},
    {"choose one by phase: ", "choose one by --phase: "},
    {"leave it out, or give periods N", "leave it out, or give --periods N"},
    {"use skip N, or time T", "use --skip N, or --time T"},
    {"name a level, until EXPR=LEVEL, or until end", "name a level, --until EXPR=LEVEL, or --until end"},
    {"or say where it begins: at VALUE", "or say where it begins: --at VALUE"},
    {"give gap and stiffness, in the units of the record", "give --gap and --stiffness, in the units of the record"},
    {"give beta1, beta2 and gap", "give --beta1, --beta2 and --gap"},
    {"choose another reference or level", "choose another --reference or --level"},
    {"name the channel of the input by reference", "name the channel of the input by --reference"},
    {"name it by channel", "name it by --channel"},
    {"or choose channel that all of them have", "or choose --channel that all of them have"},
    {"by write, or take a part of it by from and to", "by --write, or take a part of it by --from and --to"},
    {"give a part of the record whose clock is even", "give a part of the record whose clock is even (--from, --to)"},
    {"name the group whose datasets are the channels", "name the group whose datasets are the channels by --group"},
    {"lines before the names of columns can be passed over",
     "lines before the names of columns are passed over by --skip N"},
    {"say which line has the names, or pass over lines and say what the columns are",
     "say which line has the names (--names-line N), or pass over lines (--skip N) and say what the columns are "
     "(--columns)"},
    {"or pass over lines and say what the columns are",
     "or pass over lines (--skip N) and say what the columns are (--columns)"},
    {"q [mm]', or name them", "q [mm]', or name them by --columns"},
    {"permissions of the folder, or choose another one",
     "permissions of the folder, or choose another one by --output"},
    {"wait until it has ended, or choose another folder",
     "wait until it has ended, or choose another folder by --output"},
    {"run a study, which makes one", "graze run STUDY makes one, in the folder that --output names"},
    {"or choose the folder that it leads to", "or choose the folder that it leads to by --output"},
    {"export one of them at a time, or list their points",
     "export one of them at a time, by --run NAME, or all into a folder, by --output FOLDER/, or see graze points FILE "
     "--all"},
    {"export one of them at a time",
     "export one of them at a time, by --run NAME, or all into a folder, by --output FOLDER/"},
    {"; name states or expressions", "; name states or expressions by --y"},
};

struct Pattern {
    std::regex said;
    const char* told;
    Pattern(const std::pair<const char*, const char*>& words) : said(words.first), told(words.second) {}
};

/// Regular expressions, where the option takes a name of the message.
constexpr std::pair<const char*, const char*> patterns[] = {
    {R"(make it by designing (.+) into (.+)$)", "make it by: graze design $1 --output $2"},
    {R"(run '(\S+)' has no orbit number (\S+); give one of its (\d+) orbits$)",
     "run '$1' has no orbit number $2; graze points --run $1 --all lists its $3 orbits"},
    {R"(run '(\S+)' is of kind (.*); see its points$)",
     "run '$1' is of kind $2; see its results by graze export --run $1"},
    {R"re(convert it in the run that has the record: scale = \{ (.+) = \{ factor = (\S+), unit = "(.*)" \} \}$)re",
     "convert it by --scale $1=$2:$3"},
    {R"(give an approximate one by frequency$)", "give an approximate one by --frequency"},
    {R"(if the comment in line (\d+) does, name that line$)", "if the comment in line $1 does, by --names-line $1"},
};

} // namespace

std::string in_options(const std::string& message, std::span<const std::string> arguments) {
    std::string text = message;
    const std::string place = text.substr(0, text.find(": "));
    // Where an argument is so called, the place may be that file.
    if (std::ranges::count(named_places, place) > 0 && std::ranges::count(arguments, place) == 0)
        text.insert(0, "--");
    for (const Words& beginning : beginnings)
        if (text.starts_with(beginning.said)) {
            text.replace(0, beginning.said.size(), beginning.told);
            break;
        }
    const std::size_t behind = std::min(text.find("; "), text.size()); // what the problem quotes is not the library's
    for (const Words& remedy : remedies)
        if (const std::size_t at = text.find(remedy.said, behind); at != std::string::npos) {
            text.replace(at, remedy.said.size(), remedy.told);
            break;
        }
    static const std::vector<Pattern> compiled(std::begin(patterns), std::end(patterns)); // which takes milliseconds
    for (const auto& [said, told] : compiled)
        text = std::regex_replace(text, said, told);
    return text;
}

} // namespace graze
