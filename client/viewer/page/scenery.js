const BACKGROUND = 0x24262b;
const COLOURS = {leader: 0xf0a04b, follower: 0x4fb3bf};

// Materials are lit in linear light, so display colours are converted. (Background and fog are
// drawn unconverted.)
function linear(hex) {
  return new THREE.Color(hex).convertSRGBToLinear();
}

const NO_WEBGL =
    'This browser shows no WebGL: switch on hardware acceleration, or try another browser.';

// Whether the browser supports WebGL.
function drawsWebGl() {
  const canvas = document.createElement('canvas');
  return Boolean(canvas.getContext('webgl') || canvas.getContext('experimental-webgl'));
}

function makeRenderer(canvas) {
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true});
  renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  renderer.gammaOutput = true;
  renderer.gammaFactor = 2.2;
  return renderer;
}

// `reach`: the size of the scene, metres.
function makeControls(camera, canvas, reach) {
  const controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = true;
  controls.dampingFactor = 0.12;
  controls.enableKeys = false;  // the arrow keys step through frames
  controls.screenSpacePanning = true;
  controls.maxPolarAngle = Math.PI * 0.52;
  controls.minDistance = 0.4;
  controls.maxDistance = 30 + 4 * reach;
  return controls;
}

// The unit vector towards the camera of a view. `axis`: horizontal, from the leader to the
// follower.
function viewDirection(name, axis) {
  const across = axis.clone().cross(new THREE.Vector3(0, 1, 0));  // leader left, follower right
  const up = (height) => new THREE.Vector3(0, height, 0);
  const directions = {
    reset: across.clone().multiplyScalar(0.82).addScaledVector(axis, -0.42).add(up(0.3)),
    front: across.clone().add(up(0.1)),
    side: axis.clone().addScaledVector(across, 0.4).add(up(0.16)),
    top: up(1).addScaledVector(across, 0.002),
  };
  return directions[name].normalize();
}

function cornersOf({min, max}) {
  return [...Array(8).keys()].map((corner) => new THREE.Vector3(
      corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z));
}

// The distance from the centre at which all points fit into the frame, looking along -direction.
function fittingDistance(points, centre, direction, camera) {
  const side = new THREE.Vector3(0, 1, 0).cross(direction).normalize();
  const top = direction.clone().cross(side);
  const margin = 0.22;  // for the body around the joints and for the panels
  const tanV = Math.tan(THREE.Math.degToRad(camera.fov / 2));
  const tanH = tanV * camera.aspect;
  let distance = 1.5;
  const point = new THREE.Vector3();
  for (const each of points) {
    point.subVectors(each, centre);
    const depth = point.dot(direction);
    distance = Math.max(distance, depth + (Math.abs(point.dot(side)) + margin) / tanH,
                        depth + (Math.abs(point.dot(top)) + margin) / (tanV * 0.86));
  }
  return distance;
}

// The scenery of a motion: floor and lights, in the motion's coordinates.
class Scenery {
  constructor(motion, renderer, shadowPixels) {
    this.motion = motion;
    this.renderer = renderer;
    this.floor = motion.floor().height;
    this.box = motion.bounds();
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(BACKGROUND);
    this.reach = this.box.getSize(new THREE.Vector3()).length();
    this.addFog(this.reach);
    this.addLights(shadowPixels);
    this.addFloor();
  }

  // Fog that hides the floor's edge from a camera that shows everything within `reach` metres.
  addFog(reach) {
    this.scene.fog = new THREE.Fog(BACKGROUND, 5 + 2 * reach, 13 + 4 * reach);
  }

  addLights(shadowPixels) {
    const centre = this.box.getCenter(new THREE.Vector3());
    const radius = Math.max(1.6, this.box.getSize(new THREE.Vector3()).length() * 0.62);
    this.scene.add(new THREE.HemisphereLight(0xe8eefc, 0x3c3a3a, 0.62));
    const key = new THREE.DirectionalLight(0xfff3e2, 0.78);
    key.position.copy(centre).add(new THREE.Vector3(0.45, 1.5, 0.7).multiplyScalar(2 * radius));
    key.target.position.copy(centre);
    key.castShadow = true;
    key.shadow.mapSize.set(shadowPixels, shadowPixels);
    key.shadow.radius = 5;
    key.shadow.bias = -0.0006;
    Object.assign(key.shadow.camera,
                  {left: -radius, right: radius, top: radius, bottom: -radius,
                   near: 0.1, far: 6 * radius});
    const rim = new THREE.DirectionalLight(0xbcd4ff, 0.38);
    rim.position.copy(centre).add(new THREE.Vector3(-1, 0.9, -1.2));
    rim.target.position.copy(centre);
    this.lights = [key, key.target, rim, rim.target];
    this.scene.add(...this.lights);
  }

  addFloor() {
    const centre = this.box.getCenter(new THREE.Vector3());
    const size = 240;
    const grid = this.gridTexture();
    grid.repeat.set(size, size);
    const ground = new THREE.Mesh(
        new THREE.PlaneBufferGeometry(size, size),
        new THREE.MeshStandardMaterial({map: grid, roughness: 1, metalness: 0}));
    ground.rotation.x = -Math.PI / 2;
    // On a whole metre, so that the grid matches the world's.
    ground.position.set(Math.round(centre.x), this.floor, Math.round(centre.z));
    ground.receiveShadow = true;
    this.scene.add(ground);
  }

  // One square metre with its edges and fainter half metres. A texture stays smooth in the
  // distance, unlike lines.
  gridTexture() {
    const pixels = 512;
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = pixels;
    const paint = canvas.getContext('2d');
    paint.fillStyle = '#3a3d44';
    paint.fillRect(0, 0, pixels, pixels);
    for (const [at, width, colour] of [[pixels / 2, 3, '#43464e'], [0, 6, '#545861'],
                                       [pixels, 6, '#545861']]) {
      paint.fillStyle = colour;
      paint.fillRect(at - width / 2, 0, width, pixels);
      paint.fillRect(0, at - width / 2, pixels, width);
    }
    const texture = new THREE.CanvasTexture(canvas);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.encoding = THREE.sRGBEncoding;
    texture.anisotropy = this.renderer.capabilities.getMaxAnisotropy();
    return texture;
  }

  // A faint line on the floor along the path of a person's root.
  addPath(person, colour) {
    const motion = this.motion;
    const positions = motion.people[person];
    const points = [];
    for (let frame = 0; frame < motion.frames; ++frame) {
      const at = (frame * motion.joints.length + motion.root) * 3;
      points.push(new THREE.Vector3(positions[at], this.floor + 0.008, positions[at + 2]));
    }
    const line = new THREE.Line(
        new THREE.BufferGeometry().setFromPoints(points),
        new THREE.LineBasicMaterial({color: linear(colour), transparent: true, opacity: 0.55}));
    line.frustumCulled = false;
    this.scene.add(line);
    return line;
  }
}
