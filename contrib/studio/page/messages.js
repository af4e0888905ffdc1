'use strict';
// The fields that the page uses of each message, by name, with number and type. A test compares
// them with the proto files. `[]` means repeated; repeated numbers are packed.
const MESSAGES = {
  ModelSelector: {name: [1, 'string'], version: [2, 'uint32']},
  Bone: {parent_joint: [1, 'uint32'], child_joint: [2, 'uint32']},
  Model: {
    name: [1, 'string'], version: [2, 'uint32'], is_default: [4, 'bool'],
    interaction_classes: [5, 'string[]'], joint_names: [6, 'string[]'], bones: [7, 'Bone[]'],
    root_joint: [8, 'string'], accepts_follower_start: [11, 'bool'], samples: [13, 'bool'],
    answers_live: [17, 'bool'],
  },
  ListModelsRequest: {},
  ListModelsResponse: {models: [1, 'Model[]']},
  Motion: {
    joint_names: [1, 'string[]'], frame_rate_hz: [2, 'double'], unit: [3, 'enum'],
    up_axis: [4, 'enum'], frame_count: [5, 'uint32'], positions: [6, 'float[]'],
  },
  ClassWeight: {interaction_class: [1, 'string'], weight: [2, 'float']},
  LabelVector: {weights: [1, 'ClassWeight[]']},
  LabelKeyframe: {frame: [1, 'uint32'], label_vector: [2, 'LabelVector']},
  FrameRun: {first_frame: [1, 'uint32'], frame_count: [2, 'uint32']},
  Pose: {positions: [1, 'float[]']},
  Point: {x: [1, 'float'], y: [2, 'float'], z: [3, 'float']},
  Direction: {x: [1, 'float'], y: [2, 'float'], z: [3, 'float']},
  FollowerStart: {root_position: [1, 'Point'], pose: [2, 'Pose']},
  JointConstraint: {
    joint_name: [1, 'string'], frame: [2, 'uint32'], position: [3, 'Point'], softness: [4, 'float'],
  },
  SynthesizeRequest: {
    model: [1, 'ModelSelector'], leader: [2, 'Motion'], label_vector: [3, 'LabelVector'],
    label_keyframes: [4, 'LabelKeyframe[]'], follower_start: [5, 'FollowerStart'],
    partner_direction: [9, 'Direction'], seed: [10, 'uint64'], variety: [11, 'float'],
    clean_up: [12, 'enum'], candidates: [13, 'uint32'], constraints: [16, 'JointConstraint[]'],
  },
  MotionChunk: {
    first_frame: [1, 'uint32'], frame_count: [2, 'uint32'], positions: [3, 'float[]'],
  },
  MotionGrade: {
    twisted: [1, 'float'], skating: [2, 'float'], leader_skating: [3, 'float'],
    overlapping: [4, 'float'],
  },
  SynthesisSummary: {
    frame_count: [1, 'uint32'], unfamiliarity: [6, 'double'], grade: [7, 'MotionGrade'],
    constraint_metres: [8, 'float[]'],
  },
  SynthesisHeader: {seed: [10, 'uint64']},
  SynthesizeResponse: {
    header: [1, 'SynthesisHeader'], chunk: [2, 'MotionChunk'], summary: [3, 'SynthesisSummary'],
  },
  LiveHistory: {
    first_frame: [1, 'uint32'], follower_frame_count: [2, 'uint32'],
    follower_positions: [3, 'float[]'],
  },
  LiveStart: {
    model: [1, 'ModelSelector'], leader: [2, 'Motion'], label_vector: [3, 'LabelVector'],
    follower_start: [5, 'FollowerStart'], seed: [7, 'uint64'], plan_frames: [13, 'uint32'],
    history: [14, 'LiveHistory'],
  },
  LeaderFrames: {
    first_frame: [1, 'uint32'], frame_count: [2, 'uint32'], positions: [3, 'float[]'],
    capture_seconds: [4, 'double'],
  },
  LabelChange: {label_vector: [2, 'LabelVector'], ease_frames: [3, 'uint32']},
  SynthesizeLiveRequest: {
    start: [1, 'LiveStart'], frames: [2, 'LeaderFrames'], label_change: [3, 'LabelChange'],
  },
  LiveHeader: {
    model_name: [1, 'string'], model_version: [2, 'uint32'], seed: [9, 'uint64'],
    first_frame: [14, 'uint32'], history_frames: [15, 'uint32'],
  },
  FollowerFrames: {
    first_frame: [1, 'uint32'], frame_count: [2, 'uint32'], positions: [3, 'float[]'],
    plan_positions: [4, 'float[]'], capture_seconds: [6, 'double'],
  },
  LiveNotice: {kind: [1, 'enum'], frames: [2, 'FrameRun']},
  LiveSummary: {frame_count: [1, 'uint32']},
  SynthesizeLiveResponse: {
    header: [1, 'LiveHeader'], frames: [2, 'FollowerFrames'], notice: [3, 'LiveNotice'],
    summary: [4, 'LiveSummary'],
  },
  Status: {details: [3, 'Any[]']},
  Any: {type_url: [1, 'string'], value: [2, 'bytes']},
  FieldViolation: {field: [1, 'string'], description: [2, 'string']},
  BadRequest: {field_violations: [1, 'FieldViolation[]']},
};

const WIRE = {float: 5, double: 1, uint32: 0, uint64: 0, enum: 0, bool: 0};  // else 2

class Writer {
  constructor() { this.bytes = []; }

  // Whole numbers up to 2^53.
  varint(value) {
    while (value > 127) {
      this.bytes.push(value % 128 + 128);
      value = Math.floor(value / 128);
    }
    this.bytes.push(value);
  }

  number(type, value) {
    if (WIRE[type] === 0) return this.varint(Number(value));
    const view = new DataView(new ArrayBuffer(type === 'double' ? 8 : 4));
    if (type === 'double') view.setFloat64(0, value, true);
    else view.setFloat32(0, value, true);
    for (const byte of new Uint8Array(view.buffer)) this.bytes.push(byte);
  }

  delimited(data) {
    this.varint(data.length);
    for (const byte of data) this.bytes.push(byte);
  }
}

function encode(name, message) {
  const out = new Writer();
  for (const [field, value] of Object.entries(message)) {
    const [number, kind] = MESSAGES[name][field];
    const type = kind.replace('[]', '');
    if (type in WIRE && kind.endsWith('[]')) {
      const packed = new Writer();
      for (const one of value) packed.number(type, one);
      out.varint(number * 8 + 2);
      out.delimited(packed.bytes);
      continue;
    }
    for (const one of kind.endsWith('[]') ? value : [value]) {
      out.varint(number * 8 + (WIRE[type] ?? 2));
      if (type in WIRE) out.number(type, one);
      else if (type === 'string') out.delimited(new TextEncoder().encode(one));
      else out.delimited(encode(type, one));
    }
  }
  return Uint8Array.from(out.bytes);
}

class Reader {
  constructor(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.at = 0;
  }

  get done() { return this.at >= this.bytes.length; }

  varint() {
    let value = 0;
    for (let scale = 1;; scale *= 128) {
      const byte = this.view.getUint8(this.at++);
      value += (byte % 128) * scale;
      if (byte < 128) return value;
    }
  }

  number(type) {
    if (WIRE[type] === 0) return type === 'bool' ? this.varint() !== 0 : this.varint();
    this.at += type === 'double' ? 8 : 4;
    return type === 'double' ? this.view.getFloat64(this.at - 8, true)
                             : this.view.getFloat32(this.at - 4, true);
  }

  delimited() {
    const length = this.varint();
    if (this.at + length > this.bytes.length) throw new Error('the message is truncated');
    this.at += length;
    return this.bytes.subarray(this.at - length, this.at);
  }

  // Skips a field that the page does not use.
  skip(wire) {
    if (wire === 0) this.varint();
    else if (wire === 2) this.delimited();
    else this.at += wire === 1 ? 8 : 4;
  }
}

function decode(name, bytes) {
  const message = {};
  const fields = new Map(Object.entries(MESSAGES[name])
                             .map(([field, [number, kind]]) => [number, [field, kind]]));
  for (const [field, [, kind]] of Object.entries(MESSAGES[name])) {
    if (kind.endsWith('[]')) message[field] = [];
  }
  const reader = new Reader(bytes);
  while (!reader.done) {
    const key = reader.varint();
    const wire = key % 8;
    const known = fields.get(Math.floor(key / 8));
    if (!known) {
      reader.skip(wire);
      continue;
    }
    const [field, kind] = known;
    const type = kind.replace('[]', '');
    if (type in WIRE && wire === 2) {
      const packed = new Reader(reader.delimited());
      while (!packed.done) message[field].push(packed.number(type));
      continue;
    }
    const value = type in WIRE ? reader.number(type)
        : type === 'string' ? new TextDecoder().decode(reader.delimited())
        : type === 'bytes' ? reader.delimited()
        : decode(type, reader.delimited());
    if (kind.endsWith('[]')) message[field].push(value);
    else message[field] = value;
  }
  return message;
}
