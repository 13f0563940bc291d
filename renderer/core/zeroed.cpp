#include "renderer/core/zeroed.h"

#include <sys/mman.h>

#include <cstdlib>

namespace tessera {
namespace {

constexpr std::size_t kHugePage = std::size_t(2) << 20;

}  // namespace

void* allocate_zeroed(std::size_t bytes) {
    if (bytes < kHugePage) {
        void* p = std::calloc(bytes, 1);
        if (!p) throw std::bad_alloc();
        return p;
    }
    void* p = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (p == MAP_FAILED) throw std::bad_alloc();
    madvise(p, bytes,
            MADV_HUGEPAGE);  // fewer page faults; a system without them says no, which is as well
    return p;
}

void free_zeroed(void* p, std::size_t bytes) noexcept {
    if (bytes < kHugePage)
        std::free(p);
    else
        munmap(p, bytes);
}

}  // namespace tessera
