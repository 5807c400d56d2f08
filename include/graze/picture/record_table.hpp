#pragma once

#include "graze/picture/figure.hpp"
#include "graze/record/impacts.hpp"
#include "graze/record/processed_record.hpp"
#include "graze/results/table.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace graze {

/// Which table or picture is made of records.
struct RecordTableRequest {
    enum class What { channels, samples, periods, sections, extremes, spectrum, impacts };
    What what = What::channels;
    std::vector<std::string> channels{}; ///< names; none: all channels. Spectra and impacts are of one channel
    std::string reference{}; ///< of periods, sections and extremes: channel whose rising crossings begin periods
    double level = 0, hysteresis = 0; ///< of these crossings, see PeriodSettings
    std::vector<double> phases{0};    ///< of sections: parts of a period, 0 ... 1
    std::vector<std::string>
        negated{};              ///< of sections: channels whose signs the symmetric image changes; none: no image
    std::string displacement{}; ///< of impacts: channel whose corners tell their times; empty: none
    ImpactWindow impacts{};
    std::size_t part = 0; ///< of spectra: averaged over parts of so many samples; 0: the whole record is one part
    bool drawn = false;   ///< a figure is wanted, for which the rows of all samples need not be kept
    std::function<bool()> interrupted{}; ///< of spectra: called now and then; returns true to stop, without rows
};

/// Names of the tables, in the order of RecordTableRequest::What.
std::vector<std::string> record_table_names();

/// A table of records, and the figure that shows it. Records are read one after the other; their channels and units
/// must agree.
class RecordTable {
public:
    virtual ~RecordTable() = default;
    RecordTable(const RecordTable&) = delete;
    RecordTable& operator=(const RecordTable&) = delete;

    /// Reads a record to its end. @param name of the record, in the first column where there are several
    /// @throws InputError for channels that the record does not have, and as the computations of each table do
    virtual void add(const std::string& name, ProcessedRecord& record) = 0;
    const Table& table() const { return table_; }
    virtual Figure figure() const = 0;

protected:
    RecordTable(const RecordTableRequest& request, bool several) : request_(request), several_(several) {}
    /// Makes the table when the first record is known. @throws InputError when another one has other columns
    void begin(const std::vector<Table::Column>& columns);
    /// First cells of a row.
    void begin_row(const std::string& name);
    /// Indices of the channels that are asked for. @throws InputError for one that the record does not have
    std::vector<std::size_t> channels_of(const RecordHeader& header) const {
        return header.chosen_channels(request_.channels, "channel");
    }
    /// Index of the only channel that is asked for. @throws InputError with this problem when it is not one
    std::size_t only_channel(const RecordHeader& header, const char* problem) const;
    const RecordTableRequest& request() const { return request_; }
    bool several() const { return several_; }
    Table& rows() { return table_; }

private:
    RecordTableRequest request_;
    bool several_, begun_ = false;
    Table table_;
};

/// The table that is asked for. @param several whether more than one record will be added
/// @throws InputError where periods are asked for without a reference
std::unique_ptr<RecordTable> record_table(const RecordTableRequest& request, bool several);

/// Labels an axis with the name and the unit of a channel, or of the time.
void label_x(FigurePanel& panel, const Channel& channel);
void label_y(FigurePanel& panel, const Channel& channel);

} // namespace graze
