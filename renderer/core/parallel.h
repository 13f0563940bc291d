#pragma once
// Worker threads: one arena of a fixed number, every worker with denormals flushed to zero.

#include <functional>
#include <memory>
#include <string>

namespace tessera {

/// How many threads this process may use: the least of affinity, cgroup quota and
/// SLURM_CPUS_PER_TASK, at least 1.
struct ThreadLimit {
    int threads = 1;
    std::string because;  // "affinity", "cgroup", "SLURM_CPUS_PER_TASK"
};
ThreadLimit available_threads();

/// Sets flush-to-zero and denormals-are-zero in the calling thread.
void flush_denormals() noexcept;

class Workers {
public:
    /// threads <= 0: available_threads() plus that many (so -1 leaves one free), at least 1.
    explicit Workers(int threads = 0);
    ~Workers();
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    int threads() const noexcept { return threads_; }
    /// Runs task inside the arena: whatever it starts in parallel (Embree's build too) stays within
    /// the threads.
    void execute(const std::function<void()>& task);
    /// Calls body(i) for i in [0, count), each once, started in order of i as threads get free.
    void for_each(int count, const std::function<void(int)>& body);

private:
    struct Impl;
    int threads_ = 1;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tessera
