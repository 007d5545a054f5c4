import { mergeConfig } from 'vite';
import pageConfig from '../../../vite.config.ts';
import { thirdGame } from './added-lines.ts';

/** The page's build, with the third game in its registries. */
export default mergeConfig(pageConfig, { plugins: [thirdGame] });
