#pragma once
/// @file An allocator for large arrays that are read at random: straight from the operating system,
/// in huge pages where it grants them.

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <utility>

namespace freepath {

/// Whole pages, all zero, aligned to 2 MiB if that large. Memory is taken as pages are first
/// written, by the thread that writes them.
/// @throws std::bad_alloc
void* allocate_pages(std::size_t bytes);
/// Gives back what allocate_pages(bytes) returned.
void free_pages(void* pages, std::size_t bytes) noexcept;
/// Gives back the memory of the whole pages within a part of them, which then reads as zero.
void release_pages(std::span<std::byte> part) noexcept;

/// Allocator of zeroed pages for std::vector. Growing by `resize(n)` leaves new elements as the
/// operating system gave them, zero, without touching them; hence never shrink and grow again.
template <class T>
struct PageAllocator {
  using value_type = T;

  PageAllocator() = default;
  template <class U>
  PageAllocator(const PageAllocator<U>&) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t count) { return static_cast<T*>(allocate_pages(count * sizeof(T))); }
  void deallocate(T* pointer, std::size_t count) noexcept {
    free_pages(pointer, count * sizeof(T));
  }

  template <class U, class... Args>
  void construct(U* item, Args&&... args) {
    if constexpr (sizeof...(Args) != 0) std::construct_at(item, std::forward<Args>(args)...);
  }

  template <class U>
  bool operator==(const PageAllocator<U>&) const {
    return true;
  }
};

}  // namespace freepath
