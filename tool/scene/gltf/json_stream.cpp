// Builds a JSON document from the events of a parser that does not call itself, however deep the text nests.
#include "json_stream.h"

#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "../load.h"
#include "../message.h"

namespace vitrail::tool {
namespace {

using Json = nlohmann::json;

// Walks over the text and says every now and then how far it is.
class TextIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  TextIterator(const char* at, const JsonStream& stream) : at_(at), behind_(at), stream_(&stream) {}
  reference operator*() const { return *at_; }
  TextIterator& operator++() {
    if (++at_ - behind_ == kStretch) {
      stream_->parsed(behind_, at_);
      behind_ = at_;
    }
    return *this;
  }
  TextIterator operator++(int) {
    const TextIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const TextIterator& other) const { return at_ == other.at_; }

 private:
  static constexpr std::ptrdiff_t kStretch = std::ptrdiff_t{1} << 22;
  const char* at_;
  const char* behind_;
  const JsonStream* stream_;
};

class Builder final : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(const JsonStream& stream) : stream_(stream) {}

  Json take() { return std::move(root_); }

  bool null() override { return scalar(nullptr); }
  bool boolean(bool value) override { return scalar(value); }
  bool number_integer(std::int64_t value) override { return scalar(value); }
  bool number_unsigned(std::uint64_t value) override { return scalar(value); }
  bool number_float(double value, const std::string& /*text*/) override { return scalar(value); }
  bool string(std::string& value) override { return scalar(std::move(value)); }
  bool binary(Json::binary_t& /*value*/) override { return false; }
  bool start_object(std::size_t /*size*/) override { return start(Json::value_t::object); }
  bool start_array(std::size_t /*size*/) override { return start(Json::value_t::array); }
  bool end_object() override { return end(); }
  bool end_array() override { return end(); }

  bool key(std::string& name) override {
    if (skipped_ > 0) return true;
    if (open_.size() == 1) {
      skipping_ = !stream_.wanted(name);
      if (skipping_) return true;
      streamed_ = name == stream_.array;
      if (streamed_ && root_.contains(name)) stream_.restart();
    }
    member_ = &(*open_.back())[name];
    return true;
  }

  bool parse_error(std::size_t /*position*/, const std::string& /*token*/, const Json::exception& error) override {
    // Drops the library's own prefix, "[json.exception.parse_error.101] ".
    const std::string_view reason = error.what();
    const std::size_t prefix = reason.find("] ");
    throw LoadError(fmt::format("the JSON is not valid: {}",
                                oneLine(prefix == std::string_view::npos ? reason : reason.substr(prefix + 2))));
  }

 private:
  static constexpr std::size_t kDeepest = 100;

  // Puts a value where it belongs.
  Json* place(Json&& value) {
    if (open_.empty()) return &(root_ = std::move(value));
    if (streamed_ && open_.size() == 2) return &(element_ = std::move(value));
    Json& parent = *open_.back();
    if (!parent.is_array()) return &(*member_ = std::move(value));
    parent.push_back(std::move(value));
    return &parent.back();
  }

  template <typename Value>
  bool scalar(Value&& value) {
    if (skipped_ > 0) return true;
    if (skipping_) return (skipping_ = false, true);
    place(Json(std::forward<Value>(value)));
    finished();
    return true;
  }

  bool start(Json::value_t kind) {
    if (open_.size() + skipped_ == kDeepest)
      throw LoadError(fmt::format("the JSON is nested more than {} levels deep", kDeepest));
    if (skipping_ || skipped_ > 0) {
      skipping_ = false;
      ++skipped_;
      return true;
    }
    // What is to be handed over is an array, or else the check of the document finds out.
    if (open_.size() == 1 && kind != Json::value_t::array) streamed_ = false;
    open_.push_back(place(Json(kind)));
    return true;
  }

  bool end() {
    if (skipped_ > 0) {
      --skipped_;
      return true;
    }
    open_.pop_back();
    finished();
    return true;
  }

  // A value is complete.
  void finished() {
    if (open_.size() == 1) streamed_ = false;
    if (streamed_ && open_.size() == 2) stream_.element(std::move(element_));
  }

  const JsonStream& stream_;
  Json root_;
  Json element_;            // the one of the array that is being built
  std::vector<Json*> open_; // the objects and arrays around the next value
  Json* member_ = nullptr;  // where the next value of an object goes
  bool streamed_ = false;   // inside the array that is handed over
  bool skipping_ = false;   // the next value is not wanted
  std::size_t skipped_ = 0; // how many levels deep inside such a value
};

} // namespace

Json parseJson(std::string_view text, const JsonStream& stream) {
  Builder builder(stream);
  const TextIterator begin(text.data(), stream);
  const TextIterator end(text.data() + text.size(), stream);
  Json::sax_parse(begin, end, &builder);
  return builder.take();
}

} // namespace vitrail::tool
