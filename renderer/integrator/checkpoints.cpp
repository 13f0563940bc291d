#include "renderer/integrator/checkpoints.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>

#include "renderer/api/error.h"
#include "renderer/film/film_file.h"

namespace tessera {

Checkpoints::Checkpoints(std::string path, double every_s,
                         std::function<void(const std::string&)> warn)
    : path_(std::move(path)), every_s_(every_s), warn_(std::move(warn)) {
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
    const auto every = std::chrono::duration<double>(every_s_);
    while (!wake_.wait_for(lock, every, [&] { return stop_; })) {
        wanted_ = true;
        wake_.wait(lock, [&] { return stop_ || given_; });
        if (!given_) return;
        given_ = false;
        if (!copied_) continue;
        lock.unlock();
        write([&] { write_film_file(path_, header_, copies_, coverage_); });
        lock.lock();
    }
}

void Checkpoints::start(Film& film, FilmHeader header, Workers& workers) {
    const bool copied = copy(film, workers);
    if (!copied) write([&] { write_film_file(path_, header, film); });
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
        coverage_ = coverage_states(film);
    } catch (const std::bad_alloc&) {
        memory_.clear(), copies_.clear(), coverage_.clear(), bytes_ = 0;
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
