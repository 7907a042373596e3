#include "freepath/base/page_allocator.h"

#include <sys/mman.h>

#include <cstdint>
#include <limits>

namespace freepath {
namespace {

constexpr std::size_t kSmallPage = 4096;
constexpr std::size_t kHugePage = std::size_t{2} << 20;
/// Arrays from this size on get huge pages, though they may fill but a part of one: a random read
/// costs more in address translation than that memory is worth.
constexpr std::size_t kWorthHuge = kHugePage / 8;

std::size_t rounded(std::size_t bytes) {
  const std::size_t page = bytes >= kWorthHuge ? kHugePage : kSmallPage;
  if (bytes > std::numeric_limits<std::size_t>::max() - 2 * kHugePage) throw std::bad_alloc();
  return (bytes + page - 1) / page * page;
}

std::byte* map_pages(std::size_t bytes) {
  void* const pages =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED) throw std::bad_alloc();
  return static_cast<std::byte*>(pages);
}

}  // namespace

void* allocate_pages(std::size_t bytes) {
  if (bytes == 0) return nullptr;
  const std::size_t size = rounded(bytes);
  if (size < kHugePage) return map_pages(size);
  // One huge page more than needed, and what lies outside the aligned part given back.
  std::byte* const all = map_pages(size + kHugePage);
  const std::size_t head =
      (kHugePage - reinterpret_cast<std::uintptr_t>(all) % kHugePage) % kHugePage;
  std::byte* const aligned = all + head;
  if (head != 0) munmap(all, head);
  munmap(aligned + size, kHugePage - head);
  madvise(aligned, size, MADV_HUGEPAGE);  // advice: small pages serve where it is refused
  return aligned;
}

void free_pages(void* pages, std::size_t bytes) noexcept {
  if (pages != nullptr) munmap(pages, rounded(bytes));
}

void release_pages(std::span<std::byte> part) noexcept {
  const auto begin = reinterpret_cast<std::uintptr_t>(part.data());
  const std::size_t head = (kSmallPage - begin % kSmallPage) % kSmallPage;
  if (part.size() < head + kSmallPage) return;
  const std::size_t size = (part.size() - head) / kSmallPage * kSmallPage;
  madvise(part.data() + head, size, MADV_DONTNEED);
}

}  // namespace freepath
