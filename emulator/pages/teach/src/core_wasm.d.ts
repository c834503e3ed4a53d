declare module 'core.wasm' {
  const bytes: Uint8Array;
  export default bytes;
}
