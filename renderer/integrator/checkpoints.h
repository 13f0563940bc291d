#pragma once
// A film saved while its render goes on: copied with the workers at rest, written by a thread.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "renderer/core/parallel.h"
#include "renderer/film/film.h"
#include "renderer/film/film_file.h"
#include "renderer/film/film_header.h"

namespace tessera {

/// Seconds between checkpoints that each stop all threads for rest_s and then one for writing_s.
double checkpoint_interval(double rest_s, double writing_s, int threads);

class Checkpoints {
public:
    /// every_s <= 0: a minute, or as much longer as keeps the cost below kCost of the time. What
    /// cannot be written is told to warn, from any thread; the last good file stays. Without a path
    /// nothing is ever wanted.
    static constexpr double kEvery = 60, kCost = 0.01;
    Checkpoints(std::string path, double every_s, std::function<void(const std::string&)> warn);
    /// Waits for the one under way.
    ~Checkpoints();
    Checkpoints(const Checkpoints&) = delete;
    Checkpoints& operator=(const Checkpoints&) = delete;

    /// Time for one; the one before is on the disk, and its copy anybody's again.
    bool wanted() const noexcept { return wanted_.load(std::memory_order_acquire); }
    /// One is wanted now, or as soon as that under way is written.
    void hurry();
    /// Copies the film and clears wanted(). Without memory for a copy it writes at once.
    void start(Film& film, FilmHeader header, Workers& workers);
    /// Waits for the one under way; nothing is wanted afterwards.
    void stop();
    /// The last one, in this thread. Nothing is wanted afterwards.
    void finish(Film& film, const FilmHeader& header);

    /// Seconds from one to the next, and those for which the workers rested.
    double every_s() const noexcept { return every_s_; }
    double rested_s() const noexcept { return rested_s_; }
    int written() const noexcept { return written_; }
    int failed() const noexcept { return failed_; }
    /// Whether finish() wrote.
    bool saved() const noexcept { return saved_; }
    /// Of the copy.
    std::size_t bytes() const noexcept { return bytes_; }

private:
    void run();
    bool copy(Film& film, Workers& workers);
    void write(const std::function<void()>& write_file);

    std::string path_;
    bool automatic_;
    std::atomic<double> every_s_, rested_s_{0}, writing_s_{0};  // the last: the processor's
    std::function<void(const std::string&)> warn_;
    std::atomic<bool> wanted_{false};
    std::atomic<int> written_{0}, failed_{0};
    std::string last_failure_;
    bool saved_ = false;
    // A copy of the film's arrays, kept from one to the next.
    std::vector<std::unique_ptr<std::byte[]>> memory_;
    std::vector<Film::Array> copies_;
    FilmStates states_;
    std::size_t bytes_ = 0;
    FilmHeader header_;
    std::mutex mutex_;
    std::condition_variable wake_;
    bool given_ = false, copied_ = false, stop_ = false, hurry_ = false;
    std::thread thread_;
};

}  // namespace tessera
