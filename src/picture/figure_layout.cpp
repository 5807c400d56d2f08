#include "picture/figure_layout.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace graze {

namespace {

constexpr double points_per_mm = 72 / 25.4;
constexpr double usual_width = 170; ///< mm; width of the text of a page
constexpr double narrow = 120;      ///< mm; narrower pictures, as for a column of text, have a smaller font
constexpr double narrow_font = 8, usual_font = 9;
constexpr double least_panel = 42;  ///< mm; least width of the axes of panels in several columns
constexpr double flat = 0.62;       ///< height of a panel divided by its width
constexpr double flattest = 0.38;   ///< the same if the picture has one column, or a panel spans several rows
constexpr double least_height = 30; ///< points; least height of panels, even if a smaller picture was asked for
constexpr double sheet = 250;       ///< mm; greatest height of pictures without a given height, as on a sheet of A4
constexpr double legible = 20;      ///< mm; least height of panels that are made lower for that

// In units of the font size.
constexpr double line_height = 1.3, note_line = 1.25, edge_margin = 0.6, tic_length = 0.45, gap_at_tic = 0.3,
                 gap_of_panels = 1, title_size = 1.1;
constexpr std::size_t most_title_lines = 3, most_note_lines = 3;

double font_of(const FigureStyle& style, double width) {
    if (style.font_size > 0)
        return style.font_size;
    return width < narrow ? narrow_font : std::max(usual_font, usual_font * width / usual_width);
}

Box text_box(const PlacedText& text) {
    const double length = width_of(text.text) * text.size, height = text.size;
    if (text.upright)
        return Box::around(text.at, height, length);
    const double left = text.align == PlacedText::Align::left     ? text.at.x
                        : text.align == PlacedText::Align::centre ? text.at.x - length / 2
                                                                  : text.at.x - length;
    return {left, text.at.y - height / 2, left + length, text.at.y + height / 2};
}

bool is_one_word(const std::string& text) {
    return text.find(' ') == std::string::npos;
}

/// The label of an axis in at most two lines of length `room` (in font sizes): words, symbol and unit, or fewer of them
/// if they do not fit.
std::vector<RichText> axis_label(const std::string& name, const std::string& words, const std::string& unit, int power,
                                 double room, const std::vector<std::string>& symbols) {
    RichText bracket, tail; // the unit in parentheses; the same after a blank
    if (!unit.empty() || power != 0) {
        bracket = rich("(") + (power != 0 ? rich_power(power) : RichText{}) +
                  rich(power != 0 && !unit.empty() ? " " : "") + rich_unit(unit) + rich(")");
        tail = rich(" ") + bracket;
    }
    const RichText symbol = is_one_word(name) ? rich_name(name) : rich_words(name, symbols);
    const bool is_symbol = is_one_word(name) && !symbol.empty() && symbol.front().look == TextRun::Look::italic;
    const RichText end = (is_symbol ? symbol : RichText{}) + tail;
    if (words.empty() && width_of(symbol + tail) <= room)
        return {symbol + tail};
    const std::string text = words.empty() ? letters_of(symbol) : words;
    if (!words.empty() || !is_symbol) {
        const RichText blank = rich(is_symbol ? " " : "");
        const auto with_end = [&](const std::string& words_before) {
            return rich_words(words_before, symbols) + blank + end;
        };
        if (width_of(with_end(text)) <= room)
            return {with_end(text)};
        const std::vector<std::string> lines = wrapped_lines(text, room, 3);
        if (lines.size() == 1 && width_of(end) <= room)
            return {rich_words(lines[0], symbols), is_symbol ? end : bracket};
        if (lines.size() == 2 && width_of(with_end(lines[1])) <= room)
            return {rich_words(lines[0], symbols), with_end(lines[1])};
    }
    return {symbol + tail};
}

/// Computes the layout of one figure.
class Arrangement {
public:
    /// @param columns greatest number of columns of panels
    Arrangement(const Figure& figure, std::size_t columns) : figure_(&figure) {
        const double width = figure.style.width > 0 ? figure.style.width : usual_width;
        page_.font = font_of(figure.style, width);
        page_.width = width * points_per_mm;
        page_.panels.resize(figure.panels.size());
        texts_.resize(figure.panels.size());
        columns_ = std::clamp<std::size_t>(columns, 1, std::max<std::size_t>(1, figure.panels.size()));
        while (columns_ > 1 && width / static_cast<double>(columns_) < least_panel + 3 * page_.font / points_per_mm)
            --columns_;
        choose_cells();
        frame_width_ = page_.width / static_cast<double>(columns_) - 6 * page_.font;
        frame_height_ = usual_height();
        collect_legends();
    }

    FigureLayout arrange() {
        // A fixed-point iteration: heights decide on the tic labels, these on widths, and these on legends and heights.
        // Labels that do not fit are listed below the panel, which needs height too.
        constexpr int rounds = 3;
        do {
            for (int round = 0; round < rounds; ++round)
                measure();
            place_all();
        } while (needs_more_lines()); // ends, since the reserved lines only grow, and the lists are bounded
        for (std::size_t p = 0; p < page_.panels.size(); ++p)
            write_notes(p);
        return std::move(page_);
    }
    /// True when panels are too low to be legible because there are too many rows.
    bool is_crowded() const { return crowded_; }
    std::size_t columns() const { return columns_; }

private:
    double font() const { return page_.font; }
    double usual_height() const {
        const bool spanned = std::any_of(cells_.begin(), cells_.end(), [](const Cell& cell) { return cell.rows > 1; });
        const double part = spanned || (columns_ == 1 && page_.width > narrow * points_per_mm && rows_ > 1) ? flattest
                            : columns_ == 1 && page_.width > narrow * points_per_mm                         ? 0.5
                                                                                                            : flat;
        return part * frame_width_;
    }

    void collect_legends() {
        std::vector<std::vector<LegendEntry>> legends;
        for (const FigurePanel& panel : figure_->panels)
            legends.push_back(legend_entries(panel));
        const auto shared = legends.size() > 1 ? joined_legend(legends) : std::nullopt;
        page_.legend = shared.value_or(std::vector<LegendEntry>{});
        for (std::size_t p = 0; p < legends.size() && !shared; ++p)
            page_.panels[p].legend = legends[p];
    }

    /// Assigns cells row by row, from left to right, and skips cells of panels that span several rows.
    void choose_cells() {
        std::vector<std::size_t> taken(columns_, 0); // rows of each column
        std::size_t row = 0, column = 0;
        for (const FigurePanel& panel : figure_->panels) {
            while (taken[column] > row)
                if (++column == columns_) {
                    column = 0;
                    ++row;
                }
            cells_.push_back({column, row, columns_ > 1 ? std::max<std::size_t>(1, panel.rows) : 1});
            taken[column] = row + cells_.back().rows;
        }
        rows_ = std::max<std::size_t>(1, *std::max_element(taken.begin(), taken.end()));
        above_.assign(rows_, 0);
        below_.assign(rows_, 0);
    }
    std::size_t column_of(std::size_t panel) const { return cells_[panel].column; }
    std::size_t row_of(std::size_t panel) const { return cells_[panel].row; }
    std::size_t last_row_of(std::size_t panel) const { return cells_[panel].row + cells_[panel].rows - 1; }
    double height_of(std::size_t panel) const {
        double height = frame_height_;
        for (std::size_t r = row_of(panel); r < last_row_of(panel); ++r)
            height += below_[r] + above_[r + 1] + frame_height_;
        return height;
    }

    double room_at_left(std::size_t p) const {
        double numbers = 0;
        for (const PanelAxis::Tic& tic : page_.panels[p].y.tics)
            numbers = std::max(numbers, width_of(tic.text));
        const double lines = static_cast<double>(texts_[p].y_label.size());
        return font() * (numbers + gap_at_tic + tic_length + lines * line_height + 0.6);
    }
    double room_at_right(std::size_t p) const {
        const std::vector<PanelAxis::Tic>& tics = page_.panels[p].x.tics;
        return font() * (tics.empty() ? edge_margin : edge_margin + width_of(tics.back().text) / 2);
    }
    /// Wraps title and axis labels to the available lengths.
    void write_labels(std::size_t p) {
        const FigurePanel& panel = figure_->panels[p];
        const double width = frame_width_ / font();
        texts_[p].title = wrapped_lines(panel.title, width, 2);
        texts_[p].x_label =
            axis_label(panel.x_label, panel.x_words, panel.x_unit, page_.panels[p].x.power, width, figure_->symbols);
        // The label of the vertical axis may extend beside the title and the tic labels below.
        const double height = (height_of(p) + 2 * std::min(room_above(p), room_of_axis(p))) / font();
        texts_[p].y_label =
            axis_label(panel.y_label, panel.y_words, panel.y_unit, page_.panels[p].y.power, height, figure_->symbols);
    }
    double room_above(std::size_t p) const {
        return font() * (line_height * static_cast<double>(texts_[p].title.size()) + 0.5);
    }
    /// Height of the lines reserved for notes.
    double room_of_notes(std::size_t p) const {
        return note_line * legend_font(font()) * static_cast<double>(texts_[p].reserved);
    }
    /// Lines of a panel's own notes, then of the lists of its labels; at most two if the figure's height is given.
    std::vector<std::string> notes_of(std::size_t p) const {
        constexpr std::size_t most_on_given_height = 2;
        std::vector<std::string> all = figure_->panels[p].notes;
        const std::vector<std::string>& of_labels = page_.panels[p].labels.notes;
        all.insert(all.end(), of_labels.begin(), of_labels.end());
        std::vector<std::string> lines;
        for (const std::string& note : all)
            for (std::string& text :
                 wrapped_lines(note, column_width(column_of(p)) / legend_font(font()), most_note_lines))
                lines.push_back(std::move(text));
        if (figure_->style.height > 0 && lines.size() > most_on_given_height) {
            lines.resize(most_on_given_height);
            lines.back() += "…";
        }
        return lines;
    }
    /// Updates the notes. @return true if they need more lines than are reserved
    bool needs_more_lines() {
        bool more = false;
        for (std::size_t p = 0; p < page_.panels.size(); ++p) {
            texts_[p].notes = notes_of(p);
            more = more || texts_[p].notes.size() > texts_[p].reserved;
            texts_[p].reserved = std::max(texts_[p].reserved, texts_[p].notes.size());
        }
        return more;
    }
    double room_of_axis(std::size_t p) const {
        return font() *
               (tic_length + gap_at_tic + 1 + 0.2 + line_height * static_cast<double>(texts_[p].x_label.size()) + 0.2);
    }

    void measure() {
        left_.assign(columns_, 0);
        right_.assign(columns_, font() * edge_margin);
        for (std::size_t p = 0; p < page_.panels.size(); ++p) {
            PanelLayout& panel = page_.panels[p];
            panel.y = panel_axis(figure_->panels[p], false, height_of(p), font());
            panel.x = panel_axis(figure_->panels[p], true, frame_width_, font());
            write_labels(p);
            left_[column_of(p)] = std::max(left_[column_of(p)], room_at_left(p));
            right_[column_of(p)] = std::max(right_[column_of(p)], room_at_right(p));
        }
        const double beside = std::accumulate(left_.begin(), left_.end(), 0.0) +
                              std::accumulate(right_.begin(), right_.end(), 0.0) + 2 * edge_margin * font();
        frame_width_ = std::max(least_height, (page_.width - beside) / static_cast<double>(columns_));
        above_.assign(rows_, 0);
        below_.assign(rows_, 0);
        for (std::size_t p = 0; p < page_.panels.size(); ++p) {
            PanelLayout& panel = page_.panels[p];
            const double legend =
                place_legend(panel.legend, 0, 0, column_width(column_of(p)), font(), figure_->symbols);
            above_[row_of(p)] = std::max(above_[row_of(p)], room_above(p));
            below_[last_row_of(p)] =
                std::max(below_[last_row_of(p)], room_of_axis(p) + legend + room_of_notes(p) + gap_of_panels * font());
        }
        title_height_ = font() * (edge_margin + title_size * line_height * static_cast<double>(figure_title().size()));
        legend_height_ = place_legend(page_.legend, edge_margin * font(), 0, page_.width - 2 * edge_margin * font(),
                                      font(), figure_->symbols);
        const double around = title_height_ + legend_height_ + std::accumulate(above_.begin(), above_.end(), 0.0) +
                              std::accumulate(below_.begin(), below_.end(), 0.0);
        const auto height_on = [&](double page) {
            return std::max(least_height, (page * points_per_mm - around) / static_cast<double>(rows_));
        };
        frame_height_ = usual_height();
        if (figure_->style.height > 0)
            frame_height_ = height_on(figure_->style.height);
        else if (frame_height_ > height_on(sheet)) {
            crowded_ = height_on(sheet) < legible * points_per_mm;
            frame_height_ = std::min(usual_height(), std::max(height_on(sheet), legible * points_per_mm));
        }
        page_.height = around + static_cast<double>(rows_) * frame_height_;
    }

    std::vector<std::string> figure_title() const {
        return wrapped_lines(figure_->title, (page_.width - 2 * edge_margin * font()) / (title_size * font()),
                             most_title_lines);
    }
    double column_width(std::size_t column) const { return left_[column] + frame_width_ + right_[column]; }

    void place_all() {
        write_title();
        for (std::size_t p = 0; p < page_.panels.size(); ++p)
            place(p);
    }

    void write_title() {
        page_.title.clear();
        double y = page_.height - font() * edge_margin / 2;
        for (const std::string& text : figure_title()) {
            y -= title_size * line_height * font() / 2;
            add(page_.title, {words(text), {page_.width / 2, y}, title_size * font()});
            y -= title_size * line_height * font() / 2;
        }
        place_legend(page_.legend, edge_margin * font(), legend_height_ + 0.3 * font(),
                     page_.width - 2 * edge_margin * font(), font(), figure_->symbols);
    }

    void place(std::size_t p) {
        PanelLayout& panel = page_.panels[p];
        double left = edge_margin * font(), top = page_.height - title_height_;
        for (std::size_t c = 0; c < column_of(p); ++c)
            left += column_width(c);
        for (std::size_t r = 0; r < row_of(p); ++r)
            top -= above_[r] + frame_height_ + below_[r];
        Box& frame = panel.frame;
        frame.left = left + left_[column_of(p)];
        frame.right = frame.left + frame_width_;
        frame.high = top - above_[row_of(p)];
        frame.low = frame.high - height_of(p);
        panel.texts.clear();
        write(p);
        place_legend(panel.legend, left, frame.low - room_of_axis(p), column_width(column_of(p)), font(),
                     figure_->symbols);
        panel.labels = place_labels(figure_->panels[p], frame, panel.x, panel.y, font());
    }

    /// Places the notes below the legend.
    void write_notes(std::size_t p) {
        PanelLayout& panel = page_.panels[p];
        const double size = legend_font(font()), left = panel.frame.left - left_[column_of(p)];
        double y = panel.frame.low - room_of_axis(p);
        for (const LegendEntry& entry : panel.legend)
            y = std::min(y, entry.box.low);
        for (const std::string& text : texts_[p].notes) {
            y -= note_line * size / 2;
            add(panel.texts, {words(text), {left, y}, size, PlacedText::Align::left});
            y -= note_line * size / 2;
        }
    }

    RichText words(const std::string& text) const { return rich_words(text, figure_->symbols); }
    static void add(std::vector<PlacedText>& texts, PlacedText text) {
        text.box = text_box(text);
        texts.push_back(std::move(text));
    }

    /// Places all texts around the frame: title, tic labels and axis labels.
    void write(std::size_t p) {
        PanelLayout& panel = page_.panels[p];
        const Box& frame = panel.frame;
        const double middle = frame.middle().x;
        double y = frame.high + font() * (0.3 + line_height * (static_cast<double>(texts_[p].title.size()) - 0.5));
        for (const std::string& text : texts_[p].title) {
            add(panel.texts, {words(text), {middle, y}, font()});
            y -= line_height * font();
        }
        for (const PanelAxis::Tic& tic : panel.x.tics)
            add(panel.texts, {tic.text,
                              {frame.left + panel.x.share(tic.value) * frame.width(),
                               frame.low - font() * (tic_length + gap_at_tic + 0.5)},
                              font()});
        y = frame.low - font() * (tic_length + gap_at_tic + 1.2 + line_height / 2);
        for (const RichText& text : texts_[p].x_label) {
            add(panel.texts, {text, {middle, y}, font()});
            y -= line_height * font();
        }
        for (const PanelAxis::Tic& tic : panel.y.tics)
            add(panel.texts, {tic.text,
                              {frame.left - font() * (tic_length + gap_at_tic),
                               frame.low + panel.y.share(tic.value) * frame.height()},
                              font(),
                              PlacedText::Align::right});
        double x = frame.left - room_at_left(p) + font() * (line_height / 2 + 0.15);
        for (const RichText& text : texts_[p].y_label) {
            add(panel.texts, {text, {x, frame.middle().y}, font(), PlacedText::Align::centre, true});
            x += line_height * font();
        }
    }

    const Figure* figure_;
    FigureLayout page_;
    struct Cell {
        std::size_t column, row, rows;
    };
    std::vector<Cell> cells_; ///< the cell of each panel
    std::size_t columns_ = 1, rows_ = 1;
    double frame_width_ = 0, frame_height_ = 0, title_height_ = 0, legend_height_ = 0;
    std::vector<double> left_, right_; ///< for each column: space beside its frames in points
    std::vector<double> above_, below_;
    bool crowded_ = false;
    /// Lines of texts outside of a panel's frame.
    struct PanelTexts {
        std::vector<std::string> title, notes;
        std::size_t reserved = 0; ///< number of reserved lines of notes
        std::vector<RichText> x_label, y_label;
    };
    std::vector<PanelTexts> texts_; ///< for each panel
};

} // namespace

FigureLayout layout_of(const Figure& figure) {
    for (std::size_t columns = std::max<std::size_t>(1, figure.columns);; ++columns) {
        Arrangement arrangement(figure, columns);
        FigureLayout layout = arrangement.arrange();
        const bool wider = arrangement.is_crowded() && columns < figure.panels.size();
        if (!wider || arrangement.columns() < columns) // no more panels fit into a row
            return layout;
    }
}

} // namespace graze
