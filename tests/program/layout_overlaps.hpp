#pragma once

#include "program/figure_layout.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace graze::testing {

/// What stands on a page, with a name for messages.
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

/// All that lies on something else: texts, legends and frames of a page; within frames labels, symbols and leaders. And
/// what sticks out of the page or, of labels, out of their frame, or has lost its point.
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
            // Either it stands at its point, or a line leads there.
            if (!label.led && !label.box.grown(mark_size(page.font)).holds(label.point))
                found.push_back("label " + label.text + " has lost its point");
        }
    return found;
}

} // namespace graze::testing
