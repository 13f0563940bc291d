#include "renderer/integrator/checkpoints.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <new>
#include <system_error>

#include "renderer/api/error.h"

namespace tessera {
namespace {

// Of this thread: waiting for a disk costs the render nothing.
double processor_seconds() {
    std::timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double checkpoint_interval(double rest_s, double writing_s, int threads) {
    return std::max(Checkpoints::kEvery, (rest_s + writing_s / threads) / Checkpoints::kCost);
}

Checkpoints::Checkpoints(std::string path, double every_s,
                         std::function<void(const std::string&)> warn)
    : path_(std::move(path)),
      automatic_(every_s <= 0),
      every_s_(automatic_ ? kEvery : every_s),
      warn_(std::move(warn)) {
    if (path_.empty()) return;
    try {
        thread_ = std::thread([this] { run(); });
    } catch (const std::system_error&) {
        if (warn_) warn_(path_ + ": no thread to be had; written only at the end");
    }
}

Checkpoints::~Checkpoints() { stop(); }

void Checkpoints::stop() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
    wanted_ = false;
}

void Checkpoints::run() {
    std::unique_lock lock(mutex_);
    const auto every = [&] { return std::chrono::duration<double>(every_s_); };
    while (true) {
        wake_.wait_for(lock, every(), [&] { return stop_ || hurry_; });
        if (stop_) return;
        hurry_ = false;
        wanted_ = true;
        wake_.wait(lock, [&] { return stop_ || given_; });
        if (!given_) return;
        given_ = false;
        if (!copied_) continue;
        lock.unlock();
        const double start = processor_seconds();
        write([&] { write_film_file(path_, header_, copies_, states_); });
        writing_s_ = processor_seconds() - start;
        lock.lock();
    }
}

void Checkpoints::hurry() {
    {
        const std::lock_guard lock(mutex_);
        hurry_ = true;
    }
    wake_.notify_all();
}

void Checkpoints::start(Film& film, FilmHeader header, Workers& workers) {
    const auto begin = std::chrono::steady_clock::now();
    const bool copied = copy(film, workers);
    if (!copied) write([&] { write_film_file(path_, header, film); });
    const std::chrono::duration<double> rest = std::chrono::steady_clock::now() - begin;
    rested_s_ = rested_s_ + rest.count();
    // What writing takes is known from the one before.
    if (automatic_) every_s_ = checkpoint_interval(rest.count(), writing_s_, workers.threads());
    {
        const std::lock_guard lock(mutex_);
        wanted_ = false;
        header_ = std::move(header);
        copied_ = copied;
        given_ = true;
    }
    wake_.notify_all();
}

void Checkpoints::finish(Film& film, const FilmHeader& header) {
    if (path_.empty()) return;
    stop();
    const int before = written_;
    write([&] { write_film_file(path_, header, film); });
    saved_ = written_ > before;
}

bool Checkpoints::copy(Film& film, Workers& workers) {
    const std::vector<Film::Array> arrays = film.arrays();
    try {
        if (memory_.empty()) {
            for (const Film::Array& a : arrays) {
                memory_.push_back(std::make_unique_for_overwrite<std::byte[]>(a.bytes.size()));
                copies_.push_back({a.name, {memory_.back().get(), a.bytes.size()}});
                bytes_ += a.bytes.size();
            }
        }
        states_ = states_of(film);
    } catch (const std::bad_alloc&) {
        memory_.clear(), copies_.clear(), states_ = {}, bytes_ = 0;
        return false;
    }
    // By all: most of the time goes to the first touch of the copy's pages.
    struct Piece {
        const std::byte* from;
        std::byte* to;
        std::size_t bytes;
    };
    constexpr std::size_t kPiece = std::size_t{1} << 22;
    std::vector<Piece> pieces;
    for (std::size_t i = 0; i < arrays.size(); ++i) {
        const std::span<std::byte> from = arrays[i].bytes;
        for (std::size_t at = 0; at < from.size(); at += kPiece)
            pieces.push_back(
                {&from[at], &copies_[i].bytes[at], std::min(kPiece, from.size() - at)});
    }
    workers.for_each(static_cast<int>(pieces.size()),
                     [&](int i) { std::copy_n(pieces[i].from, pieces[i].bytes, pieces[i].to); });
    return true;
}

void Checkpoints::write(const std::function<void()>& write_file) {
    std::string failure;
    try {
        write_file();
        ++written_;
    } catch (const std::bad_alloc&) {
        failure = path_ + ": cannot write: out of memory";
    } catch (const std::exception& e) {
        failure = e.what();
    }
    failed_ += !failure.empty();
    // The same trouble every minute of a night is told once.
    if (warn_ && !failure.empty() && failure != last_failure_)
        warn_("checkpoint: " + failure + "; the render goes on");
    last_failure_ = failure;
}

}  // namespace tessera
