#pragma once

#include "picture/figure_look.hpp"
#include "picture/page_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace graze::testing {

/// A box on the page, with a name for messages.
struct NamedBox {
    std::string name;
    Box box;
};

inline std::vector<NamedBox> boxes_of(const FigureLayout& page) {
    std::vector<NamedBox> boxes;
    const auto add_texts = [&](const std::string& where, const std::vector<PlacedText>& texts) {
        for (const PlacedText& text : texts)
            boxes.push_back({where + ": " + letters_of(text.text), text.box});
    };
    const auto add_legend = [&](const std::string& where, const std::vector<LegendEntry>& legend) {
        for (const LegendEntry& entry : legend)
            boxes.push_back({where + " legend: " + entry.title, entry.box});
    };
    add_texts("title", page.title);
    add_legend("page", page.legend);
    for (std::size_t p = 0; p < page.panels.size(); ++p) {
        const std::string where = fmt::format("panel {}", p + 1);
        boxes.push_back({where + " frame", page.panels[p].frame});
        add_texts(where, page.panels[p].texts);
        add_legend(where, page.panels[p].legend);
    }
    return boxes;
}

/// Messages about overlaps of texts, legends and frames of a page, and of labels and symbols within frames; about boxes
/// beyond the page, labels beyond their frame, and labels away from their point without a leader.
inline std::vector<std::string> overlaps_of(const FigureLayout& page) {
    std::vector<std::string> found;
    const std::vector<NamedBox> boxes = boxes_of(page);
    const Box paper{0, 0, page.width, page.height};
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!paper.holds(boxes[i].box))
            found.push_back(boxes[i].name + " sticks out of the page");
        for (std::size_t k = i + 1; k < boxes.size(); ++k)
            if (boxes[i].box.meets(boxes[k].box.grown(-1e-6))) // rows of a legend touch
                found.push_back(boxes[i].name + " lies on " + boxes[k].name);
    }
    for (const PanelLayout& panel : page.panels)
        for (std::size_t i = 0; i < panel.labels.labels.size(); ++i) {
            const PlacedLabel& label = panel.labels.labels[i];
            if (!panel.frame.holds(label.box))
                found.push_back("label " + label.text + " sticks out of its frame");
            for (std::size_t k = i + 1; k < panel.labels.labels.size(); ++k)
                if (label.box.meets(panel.labels.labels[k].box))
                    found.push_back("label " + label.text + " lies on label " + panel.labels.labels[k].text);
            for (const Box& mark : panel.labels.marks)
                if (label.box.meets(mark))
                    found.push_back("label " + label.text + " lies on a symbol");
            // A label stands at its point or has a leader.
            if (!label.led && !label.box.grown(mark_size(page.font)).holds(label.point))
                found.push_back("label " + label.text + " has lost its point");
        }
    return found;
}

/// Messages about labels that a line of their panel crosses. @param counted is increased by the number of labels
inline std::vector<std::string> labels_on_lines(const Figure& figure, const FigureLayout& page, std::size_t& counted) {
    constexpr double step = 0.5; // points, which is less than the width of a line
    std::vector<std::string> found;
    for (std::size_t p = 0; p < page.panels.size(); ++p) {
        const PanelLayout& layout = page.panels[p];
        std::set<std::string> crossed;
        counted += layout.labels.labels.size();
        for (const FigureSeries& series : figure.panels[p].series) {
            if (!is_line(series.style))
                continue;
            const Polyline line = smoothed(series.points, series.along, series.corners);
            for (std::size_t i = 1; i < line.size(); ++i) {
                if (!is_drawn(line[i - 1], figure.panels[p]) || !is_drawn(line[i], figure.panels[p]))
                    continue;
                const PlanePoint from = on_page(line[i - 1], layout), to = on_page(line[i], layout);
                const double length = std::min(distance_of(from, to), 1e4);
                for (double at = 0; at <= length; at += step)
                    for (const PlacedLabel& label : layout.labels.labels)
                        if (label.box.holds(between(from, to, length > 0 ? at / length : 0)))
                            crossed.insert(label.text);
            }
        }
        for (const std::string& text : crossed)
            found.push_back(fmt::format("panel {}: a line runs through label {}", p + 1, text));
    }
    return found;
}

} // namespace graze::testing
