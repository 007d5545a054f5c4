import { Scene } from './scene';

export default function Page() {
  return <Scene />;
}
