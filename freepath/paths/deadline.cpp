#include "freepath/paths/deadline.h"

#include <algorithm>

namespace freepath {

Deadline::Deadline(double time_limit) : limit_(time_limit > 0 ? time_limit : kNever) {}

void Deadline::begin_pass(double now, bool first) {
  pass_began_ = now;
  first_pass_ = first;
}

void Deadline::request_stop(double now) { wish_ = std::min(wish_.load(), now); }

bool Deadline::is_over(double now, double done) const {
  const double wish = wish_;
  if (now < std::min(limit_, wish)) return false;
  const double latest = std::min(first_pass_ ? first_pass_limit(limit_) : later_pass_limit(limit_),
                                 wish + (first_pass_ ? kFirstPassAfterWish : 0));
  if (now >= latest) return true;
  if (done <= 0) return false;  // how long it will take is not known yet
  return pass_began_ + (now - pass_began_) / done > latest;
}

}  // namespace freepath
