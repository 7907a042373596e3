// Reads .vti files: images in VTK's XML. The markup is read by pugixml, the values from where it
// says that they are.

#include <algorithm>
#include <cmath>
#include <memory>
#include <pugixml.hpp>
#include <string>
#include <utility>

#include "freepath/base/error.h"
#include "freepath/base/memory_budget.h"
#include "freepath/base/printable.h"
#include "freepath/io/volume_text.h"
#include "freepath/io/volume_vtk.h"

namespace freepath::io {
namespace {

/// The markup of a file up to its appended data, and where those begin.
struct VtiDocument {
  std::string text;
  pugi::xml_document xml;
  uint64_t appended = 0;  ///< Place behind the mark "_"; 0: there are none.
  bool appended_base64 = false;
};

/// Attributes of the file that hold for all arrays.
struct VtiEncoding {
  std::endian order = std::endian::little;
  std::size_t word = 4;  ///< Bytes of the numbers in the heads of arrays.
  bool packed = false;
};

/// The text of a file up to the end of the tag of its appended data, if it has some.
std::string vti_markup(const VolumeFile& file, bool& has_appended) {
  constexpr std::string_view kMark = "<AppendedData";
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  std::string text;
  std::size_t mark = text.npos, end = text.npos;
  while (end == text.npos && text.size() < file.size()) {
    const std::size_t begin = text.size();
    const auto count = std::min<uint64_t>(kChunk, file.size() - begin);
    check_memory_present(file.name(), "its markup", static_cast<double>(begin + count));
    text.resize(begin + count);
    file.read(begin, std::as_writable_bytes(std::span(text)).subspan(begin));
    if (mark == text.npos) mark = text.find(kMark, begin - std::min(begin, kMark.size()));
    if (mark != text.npos) end = text.find('>', mark);
  }
  has_appended = mark != text.npos;
  if (has_appended && end == text.npos) file.fail_damaged("it ends within a tag");
  if (has_appended) text.resize(end + 1);
  return text;
}

std::shared_ptr<const VtiDocument> read_vti_document(const VolumeFile& file) {
  auto document = std::make_shared<VtiDocument>();
  bool has_appended = false;
  document->text = vti_markup(file, has_appended);
  const uint64_t behind_tag = document->text.size();
  if (has_appended) document->text += "</AppendedData></VTKFile>";
  const pugi::xml_parse_result result =
      document->xml.load_buffer_inplace(document->text.data(), document->text.size());
  if (!result) {
    file.fail_damaged(fmt::format("its XML is not well-formed near byte {}: {}", result.offset,
                                  result.description()));
  }
  if (!has_appended) return document;
  const pugi::xml_node node = document->xml.child("VTKFile").child("AppendedData");
  const std::string_view encoding = node.attribute("encoding").value();
  if (encoding != "raw" && encoding != "base64") {
    fail("{}: the encoding \"{}\" of its appended data is not known; write raw or base64",
         file.name(), excerpt(encoding));
  }
  document->appended_base64 = encoding == "base64";
  TextCursor cursor(file, behind_tag);
  constexpr int kMostBlanks = 1 << 10;
  for (int blanks = 0; blanks < kMostBlanks && !cursor.at_end(); ++blanks) {
    char c = 0;
    file.read(cursor.offset(), std::as_writable_bytes(std::span(&c, 1)));
    cursor.skip(1);
    if (c == '_') {
      document->appended = cursor.offset();
      return document;
    }
    if (!trimmed({&c, 1}).empty()) break;
  }
  file.fail_damaged("its appended data don't begin with _");
}

VtiEncoding vti_encoding(const VolumeFile& file, const pugi::xml_node& root) {
  VtiEncoding encoding;
  const std::string_view order = root.attribute("byte_order").as_string("LittleEndian");
  if (order != "LittleEndian" && order != "BigEndian") {
    fail("{}: its byte_order \"{}\" is neither LittleEndian nor BigEndian; correct it", file.name(),
         excerpt(order));
  }
  if (order == "BigEndian") encoding.order = std::endian::big;
  const std::string_view word = root.attribute("header_type").as_string("UInt32");
  if (word != "UInt32" && word != "UInt64") {
    fail("{}: its header_type \"{}\" is neither UInt32 nor UInt64; correct it", file.name(),
         excerpt(word));
  }
  if (word == "UInt64") encoding.word = 8;
  const std::string_view compressor = root.attribute("compressor").value();
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor") {
    fail("{}: its compressor {} is not known; write it with vtkZLibDataCompressor, or none",
         file.name(), excerpt(compressor));
  }
  encoding.packed = !compressor.empty();
  return encoding;
}

/// The numbers of an attribute.
std::vector<double> attribute_numbers(const VolumeFile& file, const pugi::xml_node& node,
                                      const char* name, std::size_t count) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) {
    fail("{}: <{}> has no {}; correct it", file.name(), excerpt(node.name()), name);
  }
  return header_numbers(file, name, attribute.value(), count);
}

VtkImage vti_image(const VolumeFile& file, const pugi::xml_node& image_node,
                   const pugi::xml_node& piece) {
  VtkImage image;
  const auto extent = attribute_numbers(file, piece, "Extent", 6);
  const auto whole = attribute_numbers(file, image_node, "WholeExtent", 6);
  std::array<double, 3> nodes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = extent[2 * axis], high = extent[2 * axis + 1];
    if (low < whole[2 * axis] || high > whole[2 * axis + 1] || low != std::floor(low) ||
        std::abs(low) > 1 << 30) {
      fail(
          "{}: the Extent of its piece does not lie in its WholeExtent in whole numbers; "
          "correct it",
          file.name());
    }
    image.first[axis] = static_cast<int>(low);
    nodes[axis] = high - low + 1;
  }
  image.nodes = checked_counts(file, "the Extent with", nodes);
  const auto take = [&](const char* name, Vec3d& target) {
    if (!image_node.attribute(name)) return;
    const auto numbers = attribute_numbers(file, image_node, name, 3);
    target = Vec3d(numbers[0], numbers[1], numbers[2]);
  };
  take("Origin", image.origin);
  take("Spacing", image.spacing);
  if (image_node.attribute("Direction")) {
    const auto direction = attribute_numbers(file, image_node, "Direction", 9);
    std::ranges::copy(direction, image.direction.begin());
  }
  return image;
}

/// The bytes of an array, wherever they are.
ByteSourcePointer vti_array_source(const VolumeFile& file, const VtiDocument& document,
                                   const pugi::xml_node& array, const VtiEncoding& encoding,
                                   uint64_t bytes) {
  const std::string_view format = array.attribute("format").as_string("ascii");
  if (format == "binary") {
    return vtk_array_bytes(base64_bytes(memory_bytes(file, array.child_value())), encoding.packed,
                           encoding.word, encoding.order, bytes);
  }
  const uint64_t offset = array.attribute("offset").as_ullong(UINT64_MAX);
  if (document.appended == 0 || offset > file.size()) {
    file.fail_damaged("an array stands in appended data that are missing");
  }
  ByteSourcePointer stored = file_bytes(file, document.appended + offset);
  if (document.appended_base64) stored = base64_bytes(std::move(stored));
  return vtk_array_bytes(std::move(stored), encoding.packed, encoding.word, encoding.order, bytes);
}

/// Bytes of an array in the file, for the listing; the sizes of packed blocks are not summed up.
uint64_t vti_stored_bytes(const pugi::xml_node& array, uint64_t bytes) {
  const std::string_view text = array.child_value();
  return text.empty() ? bytes : text.size();
}

DenseGrid vti_grid(const VolumeFile& file, const std::shared_ptr<const VtiDocument>& document,
                   const VtkImage& image, VtkSamples samples, const pugi::xml_node& array,
                   const VtiEncoding& encoding) {
  const pugi::xml_attribute name = array.attribute("Name");
  DenseGrid grid = vtk_grid(image, samples, name.as_string("unnamed"));
  const int components = array.attribute("NumberOfComponents").as_int(1);
  const std::string_view type_name = array.attribute("type").value();
  const std::optional<NumberType> type = vtk_number_type(type_name);
  set_voxel_type(type, excerpt(type_name), components, grid);
  if (!grid.info.reason.empty()) return grid;
  const std::string_view format = array.attribute("format").as_string("ascii");
  if (format != "ascii" && format != "binary" && format != "appended") {
    grid.info.reason = fmt::format("its format \"{}\" is not known", excerpt(format));
    return grid;
  }
  const std::size_t voxel_bytes = size_of(*type) * static_cast<std::size_t>(components);
  check_dense_size(file, grid.counts, voxel_bytes,
                   format == "ascii" ? DensePacking::kText
                   : encoding.packed ? DensePacking::kDeflate
                                     : DensePacking::kNone);
  const uint64_t bytes = dense_bytes(grid.counts, voxel_bytes);
  grid.info.stored_bytes = vti_stored_bytes(array, bytes);
  grid.open = [&file, document, array, encoding, bytes, type = *type,
               text = format == "ascii"](const GridInfo& /*head*/) {
    if (text) return text_planes(memory_bytes(file, array.child_value()));
    return number_planes(vti_array_source(file, *document, array, encoding, bytes),
                         {type, encoding.order});
  };
  return grid;
}

}  // namespace

bool is_vti(const VolumeFile& file) {
  std::string head(std::min<uint64_t>(file.size(), 2048), '\0');
  file.read(0, std::as_writable_bytes(std::span(head)));
  std::string_view text = head;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return trimmed(text).starts_with('<') && text.find("<VTKFile") != text.npos;
}

VolumeReaderPointer open_vti(const VolumeFile& file) {
  const auto document = read_vti_document(file);
  const pugi::xml_node root = document->xml.child("VTKFile");
  const std::string_view type = root.attribute("type").value();
  if (type != "ImageData") {
    fail("{}: it holds {}, not ImageData; resample it to an image (ResampleToImage in ParaView)",
         file.name(), type.empty() ? "data of no type" : excerpt(type));
  }
  const VtiEncoding encoding = vti_encoding(file, root);
  const pugi::xml_node image_node = root.child("ImageData");
  const pugi::xml_node piece = image_node.child("Piece");
  if (!piece) file.fail_damaged("it has no <Piece> with values");
  if (piece.next_sibling("Piece")) {
    fail("{}: its image is cut into pieces; write it as one (vtkXMLImageDataWriter does by itself)",
         file.name());
  }
  const VtkImage image = vti_image(file, image_node, piece);
  std::vector<DenseGrid> grids;
  for (const auto& [group, samples] :
       {std::pair("PointData", VtkSamples::kPoints), std::pair("CellData", VtkSamples::kCells)}) {
    for (const pugi::xml_node& array : piece.child(group).children()) {
      if (array.type() != pugi::node_element) continue;
      grids.push_back(vti_grid(file, document, image, samples, array, encoding));
    }
  }
  return make_dense_reader(file, std::move(grids));
}

}  // namespace freepath::io
