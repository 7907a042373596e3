#include "freepath/scene/pbrt/token_stream.h"

#include <algorithm>
#include <utility>

namespace freepath {

void TokenStream::open(const std::filesystem::path& path, std::string text) {
  const auto name = std::make_shared<const std::string>(path.string());
  const int number = static_cast<int>(names_.size());
  names_.push_back(name);
  files_.push_back({path, std::make_unique<Lexer>(name, std::move(text), number)});
}

void TokenStream::close() {
  finished_.push_back(std::move(files_.back().lexer));
  files_.pop_back();
}

const Token& TokenStream::peek() {
  for (;;) {
    const Token& token = files_.back().lexer->peek();
    if (token.kind != TokenKind::kEnd || files_.size() <= part_ + 1) return token;
    close();
  }
}

Token TokenStream::next() {
  peek();
  return files_.back().lexer->next();
}

std::size_t TokenStream::begin_part() { return std::exchange(part_, files_.size()); }

void TokenStream::end_part(std::size_t outside) {
  close();
  part_ = outside;
}

bool TokenStream::is_open(const std::filesystem::path& path) const {
  return std::ranges::any_of(files_, [&](const OpenFile& file) {
    return file.path.lexically_normal() == path.lexically_normal();
  });
}

}  // namespace freepath
