#pragma once
/// @file Reading chunks one after the other while all threads work on those that were read.

#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>

#include "freepath/io/volume_assembly.h"

namespace freepath::io {

/// @param next returns the next chunk, null behind the last; called by one thread at a time
/// @param take returns what a chunk holds; called by several threads
/// @return the merge of all scans
/// @throws what `next` or `take` throws
template <class Chunk, class Next, class Take>
GridScan scan_chunks(const Next& next, const Take& take) {
  using tbb::filter_mode;
  using ChunkPointer = std::shared_ptr<Chunk>;
  GridScan total;
  const auto read = [&](tbb::flow_control& control) {
    ChunkPointer chunk = next();
    if (!chunk) control.stop();
    return chunk;
  };
  const auto work = [&](const ChunkPointer& chunk) { return take(*chunk); };
  const auto merge = [&](const GridScan& scan) { total.merge(scan); };
  // As many as keep all threads busy, and no more, since each is a megabyte.
  const auto in_flight = 4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_pipeline(
      in_flight, tbb::make_filter<void, ChunkPointer>(filter_mode::serial_in_order, read) &
                     tbb::make_filter<ChunkPointer, GridScan>(filter_mode::parallel, work) &
                     tbb::make_filter<GridScan, void>(filter_mode::serial_out_of_order, merge));
  return total;
}

}  // namespace freepath::io
