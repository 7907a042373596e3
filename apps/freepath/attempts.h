#pragma once
/// @file Several things that are each tried, whatever becomes of the others.

#include <exception>
#include <new>
#include <string>

#include "freepath/base/error.h"

namespace freepath::program {

/// Collects what goes wrong until all has been tried.
class Attempts {
 public:
  /// @return whether it was done; what it throws is told by finish()
  template <class Work>
  bool attempt(Work work) {
    try {
      work();
      return true;
    } catch (const std::bad_alloc&) {
      add("out of memory");
    } catch (const std::exception& error) {
      add(error.what());
    }
    return false;
  }

  bool failed() const { return !failures_.empty(); }

  /// @throws Error of all that went wrong, if anything did
  void finish() const {
    if (failed()) throw Error(failures_);
  }

 private:
  void add(const std::string& failure) {
    if (!failures_.empty()) failures_ += "; ";
    failures_ += failure;
  }

  std::string failures_;
};

}  // namespace freepath::program
