#include "renderer/core/parallel.h"

#include <immintrin.h>
#include <sched.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#ifdef TESSERA_TSAN
#include <sanitizer/tsan_interface.h>
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace tessera {
namespace {

// CPUs that the cgroup's quota comes to (v2, then v1), rounded up; 0 when there is none.
int cgroup_cpus() {
    std::string group = "/";
    std::ifstream self("/proc/self/cgroup");
    for (std::string line; std::getline(self, line);) {
        if (line.rfind("0::", 0) == 0) group = line.substr(3);
    }
    for (const std::string& folder : {"/sys/fs/cgroup" + group, std::string("/sys/fs/cgroup")}) {
        std::ifstream file(folder + "/cpu.max");
        std::string quota;
        double period = 0;
        if (file >> quota >> period && quota != "max" && period > 0) {
            return std::max(1, static_cast<int>(std::ceil(std::atof(quota.c_str()) / period)));
        }
    }
    std::ifstream quota_file("/sys/fs/cgroup/cpu/cpu.cfs_quota_us"),
        period_file("/sys/fs/cgroup/cpu/cpu.cfs_period_us");
    double quota = 0, period = 0;
    if (quota_file >> quota && period_file >> period && quota > 0 && period > 0) {
        return std::max(1, static_cast<int>(std::ceil(quota / period)));
    }
    return 0;
}

int affinity_cpus() {
    for (std::size_t cpus = 1024; cpus <= (1u << 18); cpus *= 4) {
        cpu_set_t* set = CPU_ALLOC(cpus);
        const std::size_t bytes = CPU_ALLOC_SIZE(cpus);
        const int count = sched_getaffinity(0, bytes, set) == 0 ? CPU_COUNT_S(bytes, set) : 0;
        CPU_FREE(set);
        if (count > 0) return count;
    }
    return 1;
}

// Debian's TBB is invisible to ThreadSanitizer: tell it that handing out work orders memory.
#ifdef TESSERA_TSAN
char hand_over_mark;
void hand_over() { __tsan_release(&hand_over_mark); }
void take_over() { __tsan_acquire(&hand_over_mark); }
#else
void hand_over() {}
void take_over() {}
#endif

class FlushDenormals : public tbb::task_scheduler_observer {
public:
    explicit FlushDenormals(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) {
        observe(true);
    }
    ~FlushDenormals() override { observe(false); }
    void on_scheduler_entry(bool) override { flush_denormals(); }
};

}  // namespace

ThreadLimit available_threads() {
    ThreadLimit limit{affinity_cpus(), "affinity"};
    if (const int quota = cgroup_cpus(); quota > 0 && quota < limit.threads)
        limit = {quota, "cgroup"};
    if (const char* slurm = std::getenv("SLURM_CPUS_PER_TASK")) {
        const int cpus = std::atoi(slurm);
        if (cpus > 0 && cpus < limit.threads) limit = {cpus, "SLURM_CPUS_PER_TASK"};
    }
    return limit;
}

void flush_denormals() noexcept {
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _mm_setcsr(_mm_getcsr() | 0x0040u);  // denormals are zero
}

struct Workers::Impl {
    explicit Impl(int threads)
        : control(tbb::global_control::max_allowed_parallelism, std::max(threads, 1)),
          arena(threads),
          flush(arena) {}
    tbb::global_control control;
    tbb::task_arena arena;
    FlushDenormals flush;
};

Workers::Workers(int threads) {
    threads_ = threads > 0 ? threads : std::max(1, available_threads().threads + threads);
    impl_ = std::make_unique<Impl>(threads_);
}

Workers::~Workers() = default;

void Workers::execute(const std::function<void()>& task) {
    hand_over();
    impl_->arena.execute([&] {
        take_over();
        flush_denormals();
        task();
        hand_over();
    });
    take_over();
}

void Workers::for_each(int count, const std::function<void(int)>& body) {
    // A shared counter, not a split range: items start in order, which keeps neighbours in the
    // cache together and the last ones small.
    std::atomic<int> next{0};
    execute([&] {
        hand_over();
        tbb::parallel_for(
            0, threads_,
            [&](int) {
                take_over();
                flush_denormals();
                for (int i = next.fetch_add(1); i < count; i = next.fetch_add(1)) body(i);
                hand_over();
            },
            tbb::simple_partitioner{});
        take_over();
    });
}

}  // namespace tessera
