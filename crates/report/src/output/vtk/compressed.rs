//! Compressed arrays of a `.vtu` file, as ParaView writes them: blocks of zlib behind a head of their sizes, both in base64.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::{Compress, Compression, FlushCompress};

/// The attribute of the file that names the compression.
pub const COMPRESSOR: &str = "compressor=\"vtkZLibDataCompressor\"";

/// The level of zlib's compression: that of ParaView.
const LEVEL: u32 = 5;
/// Bytes of a block before compression.
const BLOCK: usize = 1 << 15;

/// An array in base64, its length in front as 64 bits, in blocks: the head has the number of blocks, the size of a block, that of the last one,
/// and the compressed size of each. `None` where the text is no such array.
pub fn compressed(array: &str) -> Option<String> {
    let bytes = STANDARD.decode(array.trim()).ok()?;
    let values = bytes.get(8..)?;
    let mut zlib = Compress::new(Compression::new(LEVEL), true);
    let (mut sizes, mut blocks) = (Vec::new(), Vec::new());
    for block in values.chunks(BLOCK) {
        zlib.reset();
        let start = blocks.len();
        // Deflate adds five bytes to a stored block of this size, and zlib its own head and sum.
        blocks.reserve(block.len() + 64);
        zlib.compress_vec(block, &mut blocks, FlushCompress::Finish)
            .ok()?;
        sizes.push(blocks.len() - start);
    }
    let last = values.chunks(BLOCK).next_back().map_or(0, <[u8]>::len);
    let all = [sizes.len(), BLOCK, last].into_iter().chain(sizes);
    let head: Vec<u8> = all.flat_map(|size| (size as u64).to_le_bytes()).collect();
    Some(STANDARD.encode(head) + &STANDARD.encode(blocks))
}
