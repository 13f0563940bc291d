#include "renderer/cli/progress.h"

#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "renderer/cli/console.h"
#include "renderer/core/log.h"

namespace tessera {
namespace {

constexpr double kLineSeconds = 10, kLineShare = 0.05, kBarSeconds = 0.1;

int terminal_width() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool can_draw() {
    const char* const term = std::getenv("TERM");
    return isatty(STDERR_FILENO) != 0 && !(term && std::string_view(term) == "dumb");
}

std::string clock_text(double s) {
    const int t = static_cast<int>(std::min(s, 3.6e6) + 0.5);
    return t >= 3600 ? fmt::format("{}:{:02}:{:02}", t / 3600, t / 60 % 60, t % 60)
                     : fmt::format("{}:{:02}", t / 60, t % 60);
}

}  // namespace

const std::vector<std::string>& progress_styles() {
    static const std::vector<std::string> styles{"auto", "bar", "line", "json", "tractor", "none"};
    return styles;
}

ProgressPrinter::ProgressPrinter(ProgressStyle style) : style_(style) {
    if (style == ProgressStyle::automatic)
        style_ = can_draw() ? ProgressStyle::bar : ProgressStyle::line;
}

void ProgressPrinter::show(const Progress& p) {
    if (style_ == ProgressStyle::none) return;
    const std::lock_guard lock(mutex_);
    const bool end = p.fraction >= 1.0;
    if (style_ == ProgressStyle::bar) {
        if (!end && p.elapsed_s - last_time_ < kBarSeconds) return;
        bar(p);
    } else {
        if (!end && p.elapsed_s - last_time_ < kLineSeconds &&
            p.fraction - last_fraction_ < kLineShare)
            return;
        if (!end && p.elapsed_s - last_time_ < 1.0) return;
        style_ == ProgressStyle::json ? json(p) : line(p);
        if (style_ == ProgressStyle::tractor) tractor(p);
    }
    last_time_ = p.elapsed_s;
    last_fraction_ = p.fraction;
}

void ProgressPrinter::bar(const Progress& p) {
    const std::string text =
        fmt::format(" {:3.0f}% {} spp  {} left {}", std::floor(p.fraction * 100), p.spp,
                    clock_text(p.elapsed_s), clock_text(p.eta_s));
    const int room = std::clamp(terminal_width() - static_cast<int>(text.size()) - 3, 0, 60);
    const int filled = static_cast<int>(p.fraction * room);
    print_err(fmt::format("\r[{}{}]{}\033[K", std::string(filled, '#'),
                          std::string(room - filled, '.'), text));
    open_ = true;
}

void ProgressPrinter::line(const Progress& p) {
    print_err(fmt::format("progress {:.1f}% spp={} elapsed={:.0f} eta={:.0f} rss={}M\n",
                          p.fraction * 100, p.spp, p.elapsed_s, p.eta_s, peak_memory() >> 20));
}

void ProgressPrinter::json(const Progress& p) {
    print_err(
        fmt::format("{{\"progress\": {:.4f}, \"spp\": {}, \"elapsed_s\": {:.1f}, "
                    "\"eta_s\": {:.1f}, \"rss_mib\": {}}}\n",
                    p.fraction, p.spp, p.elapsed_s, p.eta_s, peak_memory() >> 20));
}

// A lost reader of the progress is no reason to end the render: failures are ignored.
void ProgressPrinter::tractor(const Progress& p) {
    const std::string text = fmt::format("TR_PROGRESS {:03.0f}%\n", std::floor(p.fraction * 100));
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
}

void ProgressPrinter::end_bar() {
    if (open_) print_err("\n");
    open_ = false;
}

void ProgressPrinter::finish() {
    const std::lock_guard lock(mutex_);
    end_bar();
}

void ProgressPrinter::warn(const std::string& text) {
    const std::lock_guard lock(mutex_);
    end_bar();
    log_warning(text);
}

void ProgressPrinter::info(const std::string& text) {
    const std::lock_guard lock(mutex_);
    end_bar();
    log_info(text);
}

std::uint64_t peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) << 10;
}

}  // namespace tessera
