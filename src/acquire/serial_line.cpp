#include "graze/acquire/serial_line.hpp"

#include "acquire/instrument_failure.hpp"
#include "graze/acquire/instrument_address.hpp"

// Asio is used header-only: nothing is linked.
#define BOOST_ERROR_CODE_HEADER_ONLY 1
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/write.hpp>

#include <array>
#include <chrono>
#include <functional>
#include <utility>

namespace graze {

namespace {

namespace asio = boost::asio;
using Error = boost::system::error_code;

constexpr double send_timeout = 5; // s; a line of a hundred characters takes a tenth of a second at 9600 baud

std::chrono::steady_clock::duration duration_of(double seconds) {
    return std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(seconds > 0 ? seconds : 0));
}

/// Lines over an Asio stream, which is read in the background during any wait.
template <class Stream>
class StreamLine : public InstrumentLine {
public:
    using Open = std::function<void(asio::io_context&, Stream&)>;

    StreamLine(std::string name, Open open) : name_(std::move(name)), open_(std::move(open)), stream_(context_) {
        start();
    }
    ~StreamLine() override { stop(); }

    void send(std::string_view line) override {
        require_open();
        const std::string text = std::string(line) + '\n';
        bool sent = false;
        Error error;
        asio::async_write(stream_, asio::buffer(text), [&](const Error& result, std::size_t) {
            error = result;
            sent = true;
        });
        const auto end = std::chrono::steady_clock::now() + duration_of(send_timeout);
        while (!sent && std::chrono::steady_clock::now() < end)
            step(end);
        if (!sent) { // the handler refers to local variables: cancel it and wait for it
            Error ignored;
            stream_.cancel(ignored);
            while (!sent && run_one())
                continue;
            fail(AcquisitionEnding::no_answer, "{} accepts no data", name_);
        }
        if (error) {
            failure_ = fmt::format("{} is closed ({})", name_, error.message());
            require_open();
        }
    }
    std::optional<std::string> receive(double wait) override {
        const auto end = std::chrono::steady_clock::now() + duration_of(wait);
        for (;;) {
            if (auto line = next_line())
                return line;
            require_open();
            if (!step(end))
                return next_line();
        }
    }
    void discard() override {
        require_open();
        for (int turn = 0; turn < 1000; ++turn) { // limits the work for a line that never ends
            forget();
            read_on();
            context_.restart();
            if (context_.poll() == 0)
                break;
        }
        forget();
        require_open();
    }
    void reopen() override {
        stop();
        stream_ = Stream(context_);
        start();
    }

private:
    void start() {
        failure_.clear();
        forget();
        open_(context_, stream_);
        read_on();
    }
    void stop() {
        Error ignored;
        stream_.close(ignored);
        context_.restart();
        while (reading_ && context_.run_one() > 0)
            continue;
        reading_ = false;
    }
    void read_on() {
        if (reading_ || !failure_.empty() || received_.size() > most_received)
            return;
        reading_ = true;
        stream_.async_read_some(asio::buffer(buffer_), [this](const Error& error, std::size_t count) {
            reading_ = false;
            received_.append(buffer_.data(), count);
            if (error && error != asio::error::operation_aborted)
                failure_ = fmt::format("{} is closed ({})", name_, error.message());
        });
    }
    bool run_one() {
        context_.restart();
        return context_.run_one() > 0;
    }
    /// Reads on, and waits for something to happen. @return whether it did before the end
    bool step(std::chrono::steady_clock::time_point end) {
        read_on();
        context_.restart();
        return context_.run_one_until(end) > 0;
    }
    void forget() {
        received_.clear();
        scanned_ = 0;
    }
    /// Extracts the next line; empty lines are skipped.
    std::optional<std::string> next_line() {
        while (!received_.empty() && (received_.front() == '\n' || received_.front() == '\r'))
            received_.erase(0, 1), scanned_ = 0;
        const std::size_t end = received_.find_first_of("\r\n", scanned_);
        if (end != std::string::npos) {
            std::string line = received_.substr(0, end);
            received_.erase(0, end + 1);
            scanned_ = 0;
            return line;
        }
        scanned_ = received_.size();
        if (received_.size() > longest_line) {
            forget();
            fail(AcquisitionEnding::garbled, "{} sends a line of more than {} bytes", name_, std::size_t{longest_line});
        }
        return std::nullopt;
    }
    void require_open() const {
        if (!failure_.empty())
            throw InstrumentError(AcquisitionEnding::line_lost, failure_);
    }

    static constexpr std::size_t most_received = std::size_t{1} << 20;

    std::string name_;
    Open open_;
    asio::io_context context_{1};
    Stream stream_;
    std::array<char, 16384> buffer_{};
    std::string received_, failure_;
    std::size_t scanned_ = 0; ///< part of received_ known to have no terminator
    bool reading_ = false;
};

template <class Option>
void set_option(asio::serial_port& port, const Option& option, const std::string& name, const char* what) {
    Error error;
    port.set_option(option, error);
    if (error)
        fail(AcquisitionEnding::line_lost, "{} cannot be set to this {} ({})", name, what, error.message());
}

void open_port(const SerialSettings& settings, asio::serial_port& port) {
    using Base = asio::serial_port_base;
    const std::string& name = settings.port;
    Error error;
    port.open(name, error);
    if (error)
        fail(AcquisitionEnding::line_lost, "serial line '{}' cannot be opened ({})", name, error.message());
    set_option(port, Base::baud_rate(settings.baud), name, "rate");
    set_option(port, Base::character_size(settings.data_bits), name, "number of data bits");
    // Asio lists parities, stop bits and flow controls in the same order.
    const auto parity = static_cast<Base::parity::type>(settings.parity);
    const auto stop_bits = static_cast<Base::stop_bits::type>(settings.stop_bits);
    const auto flow = static_cast<Base::flow_control::type>(settings.flow);
    set_option(port, Base::parity(parity), name, "parity");
    set_option(port, Base::stop_bits(stop_bits), name, "number of stop bits");
    set_option(port, Base::flow_control(flow), name, "flow control");
}

void open_socket(const std::string& host, unsigned short number, double timeout, asio::io_context& context,
                 asio::ip::tcp::socket& socket) {
    Error error;
    asio::ip::tcp::resolver resolver(context);
    const auto found = resolver.resolve(host, std::to_string(number), error);
    bool done = false;
    if (!error) {
        asio::async_connect(socket, found, [&](const Error& result, const asio::ip::tcp::endpoint&) {
            error = result;
            done = true;
        });
        const auto end = std::chrono::steady_clock::now() + duration_of(timeout);
        context.restart();
        while (!done && context.run_one_until(end) > 0)
            continue;
        if (!done) {
            Error ignored;
            socket.close(ignored);
            context.restart();
            context.run();
            error = asio::error::timed_out;
        }
    }
    if (error)
        fail(AcquisitionEnding::line_lost, "port {} of '{}' cannot be reached ({})", number, host, error.message());
    socket.set_option(asio::ip::tcp::no_delay(true), error);
}

} // namespace

std::unique_ptr<InstrumentLine> open_serial_line(const SerialSettings& settings) {
    return std::make_unique<StreamLine<asio::serial_port>>(
        fmt::format("serial line '{}'", settings.port),
        [settings](asio::io_context&, asio::serial_port& port) { open_port(settings, port); });
}

std::unique_ptr<InstrumentLine> open_tcp_line(const std::string& host, unsigned short port, double timeout) {
    return std::make_unique<StreamLine<asio::ip::tcp::socket>>(
        fmt::format("the connection to {}:{}", host, port),
        [=](asio::io_context& context, asio::ip::tcp::socket& socket) {
            open_socket(host, port, timeout, context, socket);
        });
}

std::unique_ptr<InstrumentLine> open_generator_line(const SerialSettings& settings) {
    const InstrumentAddress address = generator_address(settings.port, Place{"port", 0, 0});
    if (address.is_tcp)
        return open_tcp_line(address.name, address.port);
    SerialSettings serial = settings;
    serial.port = address.name;
    return open_serial_line(serial);
}

} // namespace graze
