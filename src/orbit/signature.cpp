#include "graze/orbit/signature.hpp"

#include "base/character.hpp"
#include "graze/base/input_error.hpp"
#include "graze/base/name_list.hpp"
#include "graze/base/require.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>

namespace graze {

const std::string& cut_name() {
    static const std::string name = "~";
    return name;
}

const std::string& rest_name() {
    static const std::string name = "equilibrium";
    return name;
}

Signature signature_of_rest(std::size_t mode) {
    return {{mode, SegmentEnd::rest, 0}};
}

bool is_rest(const Signature& signature) {
    return signature.size() == 1 && signature.front().end == SegmentEnd::rest;
}

const std::string& saddle_name() {
    static const std::string name = "saddle";
    return name;
}

bool is_homoclinic(const Signature& signature) {
    return !signature.empty() && signature.back().end == SegmentEnd::saddle;
}

const std::string& chatter_mark() {
    static const std::string mark = "*";
    return mark;
}

namespace {

constexpr std::size_t most_segments = 100000;

struct Name {
    std::string text;
    int column = 0;
};

/// Parses names and groups with repetitions into a flat list.
class SignatureReader {
public:
    SignatureReader(std::string_view text, const Place& place) : text_(text), place_(place) {}

    std::vector<Name> read() {
        std::vector<std::vector<Name>> open(1);
        std::string brackets;
        for (skip(); at_ < text_.size(); skip()) {
            const char c = text_[at_];
            if (c == '(' || c == '{') {
                brackets += c;
                open.emplace_back();
                ++at_;
            } else if (c == ')' || c == '}') {
                if (brackets.empty() || brackets.back() != (c == ')' ? '(' : '{'))
                    fail(fmt::format("'{}' closes nothing", c), "balance braces and parentheses");
                brackets.pop_back();
                ++at_;
                std::vector<Name> group = std::move(open.back());
                open.pop_back();
                append(open.back(), group, repetitions());
            } else {
                const std::size_t begin = at_;
                while (at_ < text_.size() && is_name(text_[at_]))
                    ++at_;
                if (at_ == begin)
                    fail(fmt::format("'{}' does not belong into a signature",
                                     text_.substr(at_, character_at(text_, at_).bytes)),
                         "list labels as in (J1 J8)^2");
                const Name name{std::string(text_.substr(begin, at_ - begin)), static_cast<int>(begin)};
                append(open.back(), {name}, repetitions());
            }
        }
        if (!brackets.empty())
            fail(fmt::format("'{}' is not closed", brackets.back()), "balance braces and parentheses");
        if (open.front().empty())
            fail("the signature is empty", "list at least one event or section");
        return open.front();
    }

    [[noreturn]] void fail(const std::string& problem, const std::string& remedy,
                           std::optional<int> column = {}) const {
        Place place = place_;
        if (place.column > 0)
            place.column += column.value_or(static_cast<int>(std::min(at_, text_.size())));
        throw InputError(place, fmt::format("in the signature '{}': {}", text_, problem), remedy);
    }

private:
    static bool is_name(char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
               c == ':' || c == cut_name().front() || c == chatter_mark().front();
    }
    void skip() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == ',' || text_[at_] == '\t'))
            ++at_;
    }
    std::size_t repetitions() {
        skip();
        if (at_ >= text_.size() || text_[at_] != '^')
            return 1;
        ++at_;
        skip();
        std::size_t count = 0;
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), count);
        if (error != std::errc() || count == 0 || count > most_segments)
            fail("what follows ^ is not a number of repetitions", "give a whole number from 1 on");
        at_ = static_cast<std::size_t>(end - text_.data());
        return count;
    }
    void append(std::vector<Name>& to, const std::vector<Name>& names, std::size_t times) {
        if (to.size() + names.size() * times > most_segments)
            fail("it has too many segments", fmt::format("keep to {}", most_segments));
        for (std::size_t i = 0; i < times; ++i)
            to.insert(to.end(), names.begin(), names.end());
    }

    std::string_view text_;
    const Place& place_;
    std::size_t at_ = 0;
};

/// Returns all segments that a name may denote. A label comes before an event of the same name: contacts that close one
/// by one and at once have the labels `free:floor` and `free:floor-wall`, and both are the event `floor` of `free`.
std::vector<Segment> candidates(const Model& model, const std::string& name) {
    std::vector<Segment> result;
    const auto colon = name.find(':');
    std::optional<std::size_t> mode;
    if (colon != std::string::npos)
        mode = model.find_mode(name.substr(0, colon));
    const std::string rest = mode ? name.substr(colon + 1) : name;
    if (name.ends_with(chatter_mark())) {
        for (Segment& segment : candidates(model, name.substr(0, name.size() - chatter_mark().size())))
            if (segment.end == SegmentEnd::event && model.transitions[segment.index].chatter) {
                segment.end = SegmentEnd::chatter;
                result.push_back(segment);
            }
        return result;
    }
    const auto matches = [&](const Transition& transition, bool by_label) {
        const bool in_mode = !mode || transition.mode == *mode;
        const bool labelled = transition.label == name || (in_mode && transition.label == rest);
        return by_label ? labelled : !labelled && mode && in_mode && model.events[transition.event].name == rest;
    };
    for (const bool by_label : {true, false})
        for (std::size_t t = 0; t < model.transitions.size(); ++t)
            if (matches(model.transitions[t], by_label))
                result.push_back({model.transitions[t].mode, SegmentEnd::event, t});
    if (const auto section = model.find_section(rest))
        for (std::size_t m = 0; m < model.modes.size(); ++m)
            if (!mode || m == *mode)
                result.push_back({m, SegmentEnd::section, *section});
    for (const auto& [special, end] : {std::pair(cut_name(), SegmentEnd::cut), std::pair(rest_name(), SegmentEnd::rest),
                                       std::pair(saddle_name(), SegmentEnd::saddle)})
        for (std::size_t m = 0; rest == special && m < model.modes.size(); ++m)
            if (!mode || m == *mode)
                result.push_back({m, end, 0});
    return result;
}

bool can_follow(const Model& model, const Segment& before, const Segment& after) {
    if (before.end == SegmentEnd::rest || after.end == SegmentEnd::rest)
        return before == after;
    if (before.end == SegmentEnd::chatter)
        return model.transitions[before.index].chatter->mode == after.mode;
    return before.end == SegmentEnd::event ? can_lead_to(model.transitions[before.index], after.mode)
                                           : before.mode == after.mode;
}

/// Says why places, of which each can follow the one before, make no cycle.
std::string why_no_cycle(const Model& model, const std::vector<Name>& names,
                         const std::vector<std::vector<Segment>>& places) {
    std::vector<Segment> reached = places.front();
    for (std::size_t k = 1; k <= places.size(); ++k) {
        const std::size_t place = k % places.size();
        const auto can_come = [&](const Segment& after) {
            return std::ranges::any_of(reached, [&](const Segment& one) { return can_follow(model, one, after); });
        };
        std::vector<Segment> next;
        std::ranges::copy_if(places[place], std::back_inserter(next), can_come);
        if (next.empty()) {
            std::vector<std::string> after, wanted;
            for (std::size_t m = 0; m < model.modes.size(); ++m) {
                if (can_come({m, SegmentEnd::cut, 0}))
                    after.push_back(fmt::format("'{}'", model.modes[m].name));
                if (std::ranges::find(places[place], m, &Segment::mode) != places[place].end())
                    wanted.push_back(fmt::format("'{}'", model.modes[m].name));
            }
            return fmt::format(
                "'{}' {}, and '{}', {}, is in {}", names[k - 1].text,
                after.empty() ? "ends the motion" : fmt::format("leads to mode {}", fmt::join(after, " or ")),
                names[place].text, place == 0 ? "the first segment" : "which follows", fmt::join(wanted, " or "));
        }
        reached = std::move(next);
    }
    return "no cycle of the model's graph has these transitions";
}

/// Chooses one candidate for each place so that each can follow the previous one, cyclically; empty if that is
/// impossible.
std::optional<Signature> choose(const Model& model, const std::vector<std::vector<Segment>>& places) {
    const std::size_t count = places.size();
    for (const Segment& first : places[0]) {
        // reached[k][c]: the candidate of place k - 1 from which candidate c of place k was reached.
        constexpr auto none = static_cast<std::size_t>(-1);
        std::vector<std::vector<std::size_t>> reached(count);
        for (std::size_t k = 1; k < count; ++k) {
            reached[k].assign(places[k].size(), none);
            for (std::size_t b = 0; b < places[k - 1].size(); ++b) {
                const bool open = k == 1 ? places[0][b] == first : reached[k - 1][b] != none;
                for (std::size_t c = 0; open && c < places[k].size(); ++c)
                    if (reached[k][c] == none && can_follow(model, places[k - 1][b], places[k][c]))
                        reached[k][c] = b;
            }
        }
        for (std::size_t c = 0; c < places[count - 1].size(); ++c) {
            const bool open = count == 1 ? places[0][c] == first : reached[count - 1][c] != none;
            if (!open || !can_follow(model, places[count - 1][c], first))
                continue;
            Signature result(count);
            std::size_t at = c;
            for (std::size_t k = count; k-- > 0;) {
                result[k] = places[k][at];
                if (k > 0)
                    at = reached[k][at];
            }
            return result;
        }
    }
    return std::nullopt;
}

std::string joined(const std::vector<std::string>& names, std::size_t first, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += (i > 0 ? " " : "") + names[first + i];
    return text;
}

/// Returns the length and repetition count of the block whose repetitions from `begin` on cover the most names.
std::pair<std::size_t, std::size_t> best_repetition(const std::vector<std::string>& names, std::size_t begin) {
    constexpr std::size_t longest_block = 64;
    std::size_t best_length = 1, best_times = 1;
    for (std::size_t length = 1; length <= longest_block && begin + 2 * length <= names.size(); ++length) {
        std::size_t times = 1;
        while (begin + (times + 1) * length <= names.size() &&
               std::equal(names.begin() + static_cast<std::ptrdiff_t>(begin),
                          names.begin() + static_cast<std::ptrdiff_t>(begin + length),
                          names.begin() + static_cast<std::ptrdiff_t>(begin + times * length)))
            ++times;
        if (times > 1 && length * times > best_length * best_times) {
            best_length = length;
            best_times = times;
        }
    }
    return {best_length, best_times};
}

} // namespace

bool can_lead_to(const Transition& transition, std::size_t mode) {
    return std::ranges::any_of(transition.next,
                               [&](const Alternative& alternative) { return alternative.mode == mode; });
}

const Transition* transition_of(const Model& model, const Segment& segment) {
    if (!ends_by_transition(segment))
        return nullptr;
    require_index(segment.index, model.transitions.size(), "transition");
    return &model.transitions[segment.index];
}

std::string end_name(const Model& model, const Segment& segment) {
    if (segment.end == SegmentEnd::cut)
        return cut_name();
    if (segment.end == SegmentEnd::rest)
        return rest_name();
    if (segment.end == SegmentEnd::saddle)
        return saddle_name();
    if (const Transition* const transition = transition_of(model, segment))
        return segment.end == SegmentEnd::chatter ? transition->label + chatter_mark() : transition->label;
    require_index(segment.index, model.sections.size(), "section");
    return model.sections[segment.index].name;
}

Signature parse_signature(const Model& model, std::string_view text, const Place& place) {
    SignatureReader reader(text, place);
    const std::vector<Name> names = reader.read();
    std::vector<std::vector<Segment>> places;
    for (const Name& name : names) {
        places.push_back(candidates(model, name.text));
        if (!places.back().empty())
            continue;
        if (name.text.ends_with(chatter_mark()) &&
            !candidates(model, name.text.substr(0, name.text.size() - 1)).empty())
            reader.fail(fmt::format("the model does not say what follows where contacts accumulate ('{}')", name.text),
                        "give the transition `chatter = { jump = ..., mode = ... }`", name.column);
        std::vector<std::string> known;
        for (const Transition& transition : model.transitions)
            known.push_back(transition.label);
        for (const Section& section : model.sections)
            known.push_back(section.name);
        const std::string near = nearest_name(name.text, known);
        reader.fail(fmt::format("the model has no transition or section '{}'", name.text),
                    near.empty() ? "use labels of transitions and names of sections"
                                 : fmt::format("did you mean '{}'?", near),
                    name.column);
    }
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
        bool possible = false;
        for (const Segment& before : places[k])
            for (const Segment& after : places[k + 1])
                possible = possible || can_follow(model, before, after);
        if (!possible)
            reader.fail(fmt::format("'{}' cannot follow '{}'", names[k + 1].text, names[k].text),
                        "look at the transitions of the model", names[k + 1].column);
    }
    const auto signature = choose(model, places);
    if (signature && signature->size() > 1 && signature->front().end == SegmentEnd::rest)
        reader.fail("an equilibrium is the only segment of its signature", "write it once", names.back().column);
    if (signature)
        for (std::size_t k = 0; k + 1 < signature->size(); ++k)
            if ((*signature)[k].end == SegmentEnd::saddle)
                reader.fail("a homoclinic orbit ends where it approaches its saddle",
                            fmt::format("write '{}' once, at the end", saddle_name()), names[k].column);
    if (!signature)
        reader.fail(why_no_cycle(model, names, places), "add the segments between them, or leave some out",
                    names.front().column);
    return *signature;
}

std::string to_string(const Model& model, const Signature& signature) {
    // An ambiguous name is qualified by its mode.
    std::vector<std::string> names;
    for (const Segment& segment : signature) {
        require_index(segment.mode, model.modes.size(), "mode");
        const std::string name = end_name(model, segment);
        const std::size_t meanings = segment.end == SegmentEnd::section ? 1 : candidates(model, name).size();
        names.push_back(
            meanings > 1 && name.find(':') == std::string::npos ? model.modes[segment.mode].name + ":" + name : name);
    }
    std::string text;
    for (std::size_t begin = 0; begin < names.size();) {
        const auto [length, times] = best_repetition(names, begin);
        const std::string block = joined(names, begin, length);
        text += text.empty() ? "" : " ";
        if (times == 1)
            text += block;
        else
            text += length == 1 ? fmt::format("{}^{}", block, times) : fmt::format("({})^{}", block, times);
        begin += length * times;
    }
    return text;
}

void validate_signature(const Model& model, const Signature& signature, const Place& place,
                        std::optional<std::size_t> symmetry) {
    if (signature.empty())
        throw InputError(place, "the signature is empty", "list at least one event or section");
    if (symmetry)
        require_index(*symmetry, model.symmetries.size(), "symmetry");
    for (const Segment& segment : signature) {
        const bool contact = ends_by_transition(segment);
        if (!contact && segment.end != SegmentEnd::section && segment.end != SegmentEnd::cut &&
            segment.end != SegmentEnd::rest && segment.end != SegmentEnd::saddle)
            throw InputError(place, "a segment has no end", "let an event or a section end it");
        if (segment.end == SegmentEnd::rest && (signature.size() > 1 || symmetry))
            throw InputError(place, "an equilibrium is the only segment of its signature, without a symmetry",
                             "give it alone");
        if (segment.end == SegmentEnd::saddle && (&segment != &signature.back() || symmetry))
            throw InputError(place, "a homoclinic orbit ends where it approaches its saddle, without a symmetry",
                             "let that be its last segment");
        const std::size_t ends = contact                              ? model.transitions.size()
                                 : segment.end == SegmentEnd::section ? model.sections.size()
                                                                      : 1;
        const bool known = segment.index < ends;
        if (known && segment.end == SegmentEnd::chatter && !model.transitions[segment.index].chatter)
            throw InputError(place,
                             fmt::format("the transition '{}' does not say what follows where its contacts accumulate",
                                         model.transitions[segment.index].label),
                             "give it `chatter = { jump = ..., mode = ... }` in the model");
        if (!known || segment.mode >= model.modes.size() ||
            (contact && model.transitions[segment.index].mode != segment.mode))
            throw InputError(place, "the signature has a segment that the model does not have",
                             "read it by parse_signature");
    }
    for (std::size_t k = 0; k < signature.size(); ++k) {
        const Segment& before = signature[k];
        Segment after = signature[(k + 1) % signature.size()];
        if (symmetry && k + 1 == signature.size()) {
            // The mode after the last segment of a half orbit is the one whose image is the first mode.
            const auto& images = model.symmetries[*symmetry].modes;
            after.mode = static_cast<std::size_t>(std::ranges::find(images, after.mode) - images.begin());
        }
        if (!can_follow(model, before, after))
            throw InputError(place,
                             fmt::format("'{}' cannot follow '{}' in mode '{}'", end_name(model, after),
                                         end_name(model, before), model.modes[before.mode].name),
                             "look at the transitions of the model");
    }
}

} // namespace graze
