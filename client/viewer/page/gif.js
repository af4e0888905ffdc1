// A GIF 89a encoder: one palette for all frames, frames with only the changed pixels, LZW.
class GifWriter {
  // `palette`: at most 255 colours [red, green, blue]; one more index means "unchanged".
  constructor(width, height, palette) {
    this.width = width;
    this.height = height;
    this.palette = palette;
    this.bytes = [];
    this.text('GIF89a');
    this.short(width);
    this.short(height);
    this.bytes.push(0xf7, 0, 0);  // a palette of 256 colours for all frames
    for (let i = 0; i < 256; ++i) this.bytes.push(...(palette[i] || [0, 0, 0]));
    this.bytes.push(0x21, 0xff, 11);
    this.text('NETSCAPE2.0');
    this.bytes.push(3, 1, 0, 0, 0);  // repeat forever
  }

  static get AS_BEFORE() { return 255; }

  text(letters) {
    for (const letter of letters) this.bytes.push(letter.charCodeAt(0));
  }

  short(value) {
    this.bytes.push(value & 255, value >> 8);
  }

  // `indices`: palette indices [height, width]; the duration is in hundredths of a second.
  add(indices, hundredths) {
    const changes = new Uint8Array(indices.length);
    for (let i = 0; i < indices.length; ++i) {
      const same = this.before && this.before[i] === indices[i];
      changes[i] = same ? GifWriter.AS_BEFORE : indices[i];
    }
    this.before = indices;
    this.bytes.push(0x21, 0xf9, 4, 0x05);  // do not dispose; has a transparent index
    this.short(hundredths);
    this.bytes.push(GifWriter.AS_BEFORE, 0);
    this.bytes.push(0x2c, 0, 0, 0, 0);
    this.short(this.width);
    this.short(this.height);
    this.bytes.push(0);
    this.addCompressed(changes);
  }

  // LZW: codes of 9 to 12 bits, in blocks of at most 255 bytes.
  addCompressed(values) {
    const [clear, end] = [256, 257];
    const packed = [];
    let [bits, filled, size, next] = [0, 0, 9, end + 1];
    let known = new Map();
    const put = (code) => {
      bits |= code << filled;
      for (filled += size; filled >= 8; filled -= 8, bits >>>= 8) packed.push(bits & 255);
    };
    put(clear);
    let prefix = values[0];
    for (let i = 1; i < values.length; ++i) {
      const key = prefix << 8 | values[i];
      const code = known.get(key);
      if (code !== undefined) {
        prefix = code;
        continue;
      }
      put(prefix);
      prefix = values[i];
      if (next < 4096) {
        known.set(key, next);
        if (next === 1 << size) size += 1;
        next += 1;
      } else {
        put(clear);
        [size, next, known] = [9, end + 1, new Map()];
      }
    }
    put(prefix);
    put(end);
    if (filled > 0) packed.push(bits & 255);
    this.bytes.push(8);
    for (let at = 0; at < packed.length; at += 255) {
      const block = packed.slice(at, at + 255);
      this.bytes.push(block.length, ...block);
    }
    this.bytes.push(0);
  }

  blob() {
    return new Blob([Uint8Array.from([...this.bytes, 0x3b])], {type: 'image/gif'});
  }
}

// A palette for some pictures by median cut, and the lookup of the nearest colour.
class Palette {
  // `pictures`: RGBA, as in ImageData.
  constructor(pictures, count) {
    const counts = new Map();  // of colours with 5 bits per channel
    for (const pixels of pictures) {
      for (let i = 0; i < pixels.length; i += 4) {
        const key = Palette.key(pixels[i], pixels[i + 1], pixels[i + 2]);
        counts.set(key, (counts.get(key) || 0) + 1);
      }
    }
    let boxes = [[...counts].map(([key, pixels]) => ({rgb: Palette.colour(key), pixels}))];
    while (boxes.length < count) {
      boxes.sort((a, b) => Palette.weight(b) - Palette.weight(a));
      if (Palette.weight(boxes[0]) === 0) break;
      boxes = [...Palette.halves(boxes[0]), ...boxes.slice(1)];
    }
    this.colours = boxes.map(Palette.mean);
    this.nearest = new Int16Array(1 << 15).fill(-1);
  }

  static key(red, green, blue) { return red >> 3 << 10 | green >> 3 << 5 | blue >> 3; }
  static colour(key) { return [10, 5, 0].map((shift) => ((key >> shift & 31) << 3) + 4); }

  static span(box) {
    const spans = [0, 1, 2].map((channel) => {
      const values = box.map(({rgb}) => rgb[channel]);
      return values.reduce((a, b) => Math.max(a, b)) - values.reduce((a, b) => Math.min(a, b));
    });
    const span = Math.max(...spans);
    return {span, channel: spans.indexOf(span)};
  }

  // Selects the next box to cut, by width and number of pixels; a few bright pixels count too.
  static weight(box) {
    const pixels = box.reduce((sum, colour) => sum + colour.pixels, 0);
    return box.length < 2 ? 0 : Palette.span(box).span * Math.sqrt(pixels);
  }

  static halves(box) {
    const {channel} = Palette.span(box);
    const sorted = [...box].sort((a, b) => a.rgb[channel] - b.rgb[channel]);
    const half = sorted.reduce((sum, {pixels}) => sum + pixels, 0) / 2;
    let at = 0;
    for (let seen = 0; at < sorted.length - 1 && seen < half; ++at) seen += sorted[at].pixels;
    at = Math.max(1, at);
    return [sorted.slice(0, at), sorted.slice(at)];
  }

  static mean(box) {
    const pixels = box.reduce((sum, colour) => sum + colour.pixels, 0);
    return [0, 1, 2].map((channel) => Math.round(
        box.reduce((sum, colour) => sum + colour.rgb[channel] * colour.pixels, 0) / pixels));
  }

  indices(pixels) {
    const out = new Uint8Array(pixels.length / 4);
    for (let i = 0; i < out.length; ++i) {
      const key = Palette.key(pixels[4 * i], pixels[4 * i + 1], pixels[4 * i + 2]);
      if (this.nearest[key] < 0) this.nearest[key] = this.find(Palette.colour(key));
      out[i] = this.nearest[key];
    }
    return out;
  }

  find([red, green, blue]) {
    let [best, least] = [0, Infinity];
    this.colours.forEach(([r, g, b], i) => {
      const distance = (r - red) ** 2 + (g - green) ** 2 + (b - blue) ** 2;
      if (distance < least) [best, least] = [i, distance];
    });
    return best;
  }
}
