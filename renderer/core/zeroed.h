#pragma once
// Arrays that begin as zeros which nobody wrote: pages come from the system when they are first
// touched, by whichever worker that is. Large films are made in no time, and each part lies near
// the thread that renders it.

#include <cstddef>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace tessera {

/// bytes > 0, all zero. Throws std::bad_alloc.
void* allocate_zeroed(std::size_t bytes);
void free_zeroed(void* p, std::size_t bytes) noexcept;

/// For T whose zero bytes are T{}.
template <class T>
struct ZeroedAllocator {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    using value_type = T;

    ZeroedAllocator() = default;
    template <class U>
    ZeroedAllocator(const ZeroedAllocator<U>&) noexcept {}

    T* allocate(std::size_t n) {
        if (n > static_cast<std::size_t>(-1) / sizeof(T)) throw std::bad_array_new_length();
        return static_cast<T*>(allocate_zeroed(n * sizeof(T)));
    }
    void deallocate(T* p, std::size_t n) noexcept { free_zeroed(p, n * sizeof(T)); }

    // What resize() makes is there already.
    void construct(T*) noexcept {}
    template <class... Args>
    void construct(T* p, Args&&... args) {
        ::new (static_cast<void*>(p)) T(std::forward<Args>(args)...);
    }
    bool operator==(const ZeroedAllocator&) const = default;
};

/// Sized once: what a vector would make anew after it shrank would not be zero.
template <class T>
using ZeroedArray = std::vector<T, ZeroedAllocator<T>>;

}  // namespace tessera
